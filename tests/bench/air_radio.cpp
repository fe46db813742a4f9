/*
 * tsr::Air and the firmware's MAC, asked what ns3_radio asks of ns-3:
 *
 *   air_radio per PSDU_LEN FRAMES SNR_DB...                      frames received, of the medium alone
 *   air_radio contend CONTENDERS PSDU_LEN SECONDS SEED OPTION... frames acknowledged, of medium and MAC
 *
 * Options: capture=DB (default: what makes a frame count as noise of its level,
 * as in ns-3), ifs=US (default: what ns-3 waits after an acknowledgement), cca=end (as ns-3.37
 * reads it).
 * Prints one line of JSON. Contenders stand on a circle of 10 m around the
 * receiver and always have a frame to send; the first second does not count.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

extern "C" {
#include "tsr/net/mac.h"
}
#include "tsr/emulator/event_queue.h"
#include "tsr/hal/air.h"
#include "tsr/hal/air/chance.h"
#include "tsr/host/aes.h"

using namespace tsr;

namespace
{

constexpr std::uint16_t kPan = 0xbeef;
constexpr double kRadiusM = 10;
constexpr std::uint16_t kReceiver = 1;
constexpr std::uint64_t kSecondUs = 1'000'000;
/* macSifsPeriod 12 and macLifsPeriod 40 symbols, by aMaxSifsFrameSize (IEEE 802.15.4-2006, 7.5.1.3). */
constexpr std::uint64_t kShortIfsUs = 12 * TSR_RADIO_SYMBOL_US;
constexpr std::uint64_t kLongIfsUs = 40 * TSR_RADIO_SYMBOL_US;
constexpr std::size_t kShortIfsLen = 18;

Air::Clock clock_of(EventQueue &queue)
{
    return {[&queue] { return queue.now_us(); },
            [&queue](std::uint64_t at_us, std::function<void()> action) { queue.at(at_us, std::move(action)); }};
}

/* Capture at which a frame counts as noise of its level. */
double capture_as_noise_db()
{
    return air::PacketError().sensitivity_sinr_q4() / 16.0;
}

/* A frame from one radio to another, whose level above the noise is the SNR. */
int frame_errors(std::size_t psdu_len, int frames, const std::vector<double> &snrs_db)
{
    std::vector<std::uint8_t> psdu(psdu_len, 0);
    psdu[0] = 0x41; /* a data frame, no acknowledgement, to PAN and address below */
    psdu[1] = 0x98;
    psdu[3] = kPan & 0xff;
    psdu[4] = kPan >> 8;
    psdu[5] = psdu[6] = 0xff;
    std::printf("{\"frames\": %d, \"received\": [", frames);
    for (std::size_t i = 0; i < snrs_db.size(); ++i) {
        AirModel model;
        model.seed = i + 1;
        model.reference_loss_db = -(model.sensitivity_dbm - capture_as_noise_db() + snrs_db[i]);
        EventQueue queue;
        Air air(model, clock_of(queue));
        int received = 0;
        for (int radio = 0; radio < 2; ++radio) {
            air.add_radio({1.0 * radio, 0, 0}, [&received](const tsr_radio_event &event) {
                received += event.kind == TSR_RADIO_RECEIVED ? 1 : 0;
            });
            const tsr_radio made = air.radio(static_cast<std::size_t>(radio));
            made.ops->configure(made.self, 15, kPan, static_cast<std::uint16_t>(radio + 1));
            made.ops->set_receiving(made.self, radio == 1);
        }
        const tsr_radio sender = air.radio(0);
        for (int frame = 0; frame < frames; ++frame) {
            sender.ops->transmit(sender.self, psdu.data(), psdu.size());
            while (!queue.empty()) {
                queue.run_next();
            }
        }
        std::printf("%s%d", i == 0 ? "" : ", ", received);
    }
    std::printf("]}\n");
    return 0;
}

struct Counts {
    unsigned long acked = 0, unanswered = 0, blocked = 0;
};

struct Contention {
    int contenders = 0;
    std::size_t psdu_len = 0;
    double seconds = 0;
    std::uint64_t seed = 0;
    double capture_db = capture_as_noise_db();
    std::uint64_t ifs_us = 0;
    bool cca_at_end = false;
};

/* A node that has a MAC and nothing else; a contender always has a frame to send. */
class Station
{
  public:
    Station(const Contention &contention, EventQueue &queue, Counts &counts, std::uint16_t address)
        : contention_(contention), queue_(queue), counts_(counts), address_(address),
          random_(air::mix(air::mix(contention.seed) + address))
    {
    }

    void start(Air &air, const air::Position &position_m, const tsr_cipher &cipher)
    {
        const std::size_t radio = air.add_radio(position_m, [this](const tsr_radio_event &event) {
            tsr_mac_on_radio(&mac_, &event, queue_.now_us());
            serve();
        });
        const tsr_mac_config config = {kPan, address_, 15, 1};
        tsr_mac_init(&mac_, &config, &cipher, air.radio(radio), {&kEntropyOps, this});
        if (address_ != kReceiver) {
            queue_.at(1000 + random_ % 100'000, [this] { send(); });
        }
    }

  private:
    void send()
    {
        const std::vector<std::uint8_t> payload(contention_.psdu_len - TSR_FRAME_OVERHEAD_LEN, 0x5a);
        tsr_mac_send(&mac_, kReceiver, payload.data(), payload.size(), 0, false);
        serve();
    }

    /* What a node does between its interrupts, at once. */
    void serve()
    {
        while (tsr_mac_received(&mac_) != nullptr) {
            tsr_mac_release(&mac_);
        }
        tsr_mac_confirm confirm;
        while (tsr_mac_confirmed(&mac_, &confirm)) {
            count(confirm.status);
            /* ns-3 waits an inter-frame space after an acknowledgement only. */
            queue_.at(queue_.now_us() + (confirm.status == TSR_OK ? contention_.ifs_us : 0), [this] { send(); });
        }
        tsr_mac_on_timer(&mac_, queue_.now_us());
        const std::uint64_t timer_us = tsr_mac_timer_us(&mac_);
        if (timer_us != TSR_TIME_NEVER && timer_us != timer_at_us_) {
            timer_at_us_ = timer_us;
            queue_.at(timer_us, [this, timer_us] {
                if (timer_at_us_ == timer_us) {
                    timer_at_us_ = TSR_TIME_NEVER;
                    serve();
                }
            });
        }
    }

    void count(tsr_status status)
    {
        if (queue_.now_us() >= kSecondUs) {
            ++(status == TSR_OK ? counts_.acked : status == TSR_ERR_TIMEOUT ? counts_.unanswered : counts_.blocked);
        }
    }

    static void fill(void *self, std::uint8_t *bytes, std::size_t len)
    {
        auto &station = *static_cast<Station *>(self);
        for (std::size_t i = 0; i < len; ++i) {
            bytes[i] = static_cast<std::uint8_t>(air::mix(station.random_++));
        }
    }
    static constexpr tsr_entropy_ops kEntropyOps = {&Station::fill};

    const Contention &contention_;
    EventQueue &queue_;
    Counts &counts_;
    std::uint16_t address_;
    std::uint64_t random_;
    std::uint64_t timer_at_us_ = TSR_TIME_NEVER;
    tsr_mac mac_{};
};

int contend(const Contention &contention)
{
    AirModel model;
    model.seed = contention.seed;
    model.capture_db = contention.capture_db;
    model.cca_at_end = contention.cca_at_end;
    EventQueue queue;
    Air air(model, clock_of(queue));
    tsr_cipher cipher;
    const std::uint8_t key[TSR_AES_KEY_LEN] = {1};
    tsr_cipher_init(&cipher, &mbedtls_aes_ops(), key);
    Counts counts;
    std::vector<std::unique_ptr<Station>> stations;
    for (int i = 0; i <= contention.contenders; ++i) {
        const auto address = static_cast<std::uint16_t>(kReceiver + i);
        stations.push_back(std::make_unique<Station>(contention, queue, counts, address));
        const double angle = 2 * std::numbers::pi * i / contention.contenders;
        stations.back()->start(
            air, i == 0 ? air::Position{} : air::Position{kRadiusM * std::cos(angle), kRadiusM * std::sin(angle), 0},
            cipher);
    }
    const auto end_us = static_cast<std::uint64_t>((1 + contention.seconds) * kSecondUs);
    while (!queue.empty() && queue.next_us() <= end_us) {
        queue.run_next();
    }
    std::printf("{\"acked\": %lu, \"unanswered\": %lu, \"blocked\": %lu, \"psdu_len\": %zu}\n", counts.acked,
                counts.unanswered, counts.blocked, contention.psdu_len);
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.size() > 3 && words[0] == "per") {
        std::vector<double> snrs_db;
        for (std::size_t i = 3; i < words.size(); ++i) {
            snrs_db.push_back(std::atof(words[i].c_str()));
        }
        return frame_errors(static_cast<std::size_t>(std::atoi(argv[2])), std::atoi(argv[3]), snrs_db);
    }
    if (words.size() > 4 && words[0] == "contend") {
        Contention contention;
        contention.contenders = std::atoi(argv[2]);
        contention.psdu_len = static_cast<std::size_t>(std::atoi(argv[3]));
        contention.seconds = std::atof(argv[4]);
        contention.seed = static_cast<std::uint64_t>(std::atoi(argv[5]));
        contention.ifs_us = contention.psdu_len <= kShortIfsLen ? kShortIfsUs : kLongIfsUs;
        for (std::size_t i = 5; i < words.size(); ++i) {
            const std::string value = words[i].substr(words[i].find('=') + 1);
            if (words[i].starts_with("capture=")) {
                contention.capture_db = std::atof(value.c_str());
            } else if (words[i] == "cca=end") {
                contention.cca_at_end = true;
            } else if (words[i].starts_with("ifs=")) {
                contention.ifs_us = static_cast<std::uint64_t>(std::atoi(value.c_str()));
            }
        }
        return contend(contention);
    }
    std::fprintf(stderr, "air_radio: per PSDU_LEN FRAMES SNR_DB... | contend CONTENDERS PSDU_LEN SECONDS SEED ...\n");
    return 2;
}
