/*
 * ns-3's lr-wpan, asked what air_radio asks of tsr::Air:
 *
 *   ns3_radio per PSDU_LEN FRAMES SNR_DB...                   frames received, of PHY alone
 *   ns3_radio contend CONTENDERS PSDU_LEN SECONDS SEED [cca]  frames acknowledged, of PHY and MAC
 *
 * With cca a CCA notices what ends within its 8 symbols. ns-3.37 does not: its
 * PlmeCcaRequest starts with a peak of 0 and reads no power, so a CCA is busy
 * for what begins within its time or is there at its end.
 *
 * Prints one line of JSON. Contenders stand on a circle of 10 m around the
 * receiver and always have a frame to send; the first second does not count.
 *
 * C++17: ns-3.37's headers are not C++20.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <vector>

#include <ns3/constant-position-mobility-model.h>
#include <ns3/core-module.h>
#include <ns3/lr-wpan-csmaca.h>
#include <ns3/lr-wpan-error-model.h>
#include <ns3/lr-wpan-mac.h>
#include <ns3/lr-wpan-net-device.h>
#include <ns3/lr-wpan-phy.h>
#include <ns3/node.h>
#include <ns3/packet.h>
#include <ns3/propagation-delay-model.h>
#include <ns3/propagation-loss-model.h>
#include <ns3/single-model-spectrum-channel.h>

using namespace ns3;

namespace
{

constexpr uint16_t kPan = 0xbeef;
constexpr double kRadiusM = 10; /* nearer than 1 m ns-3 takes every distance for 1 m */
/* What a frame has besides its MSDU with short addresses and PAN compression: MHR 9, FCS 2 octets. */
constexpr uint32_t kOverheadLen = 11;

/* The receiver's noise as CreateNoisePowerSpectralDensity has it: k T over the 5 MHz that TotalAvgPower sums. */
double noise_dbm()
{
    return 10 * std::log10(1.3803e-23 * 290 * 5e6) + 30;
}

Mac16Address short_address(uint16_t address)
{
    const uint8_t octets[] = {static_cast<uint8_t>(address >> 8), static_cast<uint8_t>(address)};
    Mac16Address result;
    result.CopyFrom(octets);
    return result;
}

Ptr<LrWpanNetDevice> add_device(Ptr<SpectrumChannel> channel, uint16_t address, const Vector &position)
{
    auto node = CreateObject<Node>();
    auto device = CreateObject<LrWpanNetDevice>();
    auto mobility = CreateObject<ConstantPositionMobilityModel>();
    mobility->SetPosition(position);
    device->SetAddress(short_address(address));
    device->SetChannel(channel);
    node->AddDevice(device);
    device->GetPhy()->SetMobility(mobility);
    device->GetMac()->SetPanId(kPan);
    return device;
}

McpsDataRequestParams request_to(uint16_t address, bool ack)
{
    McpsDataRequestParams params;
    params.m_dstPanId = kPan;
    params.m_dstAddr = short_address(address);
    params.m_txOptions = ack ? TX_OPTION_ACK : 0;
    return params;
}

/* The PHY alone: a frame every 10 ms from one transceiver to another at a fixed level. */
int frame_errors(uint32_t psdu_len, int frames, const std::vector<double> &snrs_db)
{
    std::printf("{\"frames\": %d, \"received\": [", frames);
    for (std::size_t i = 0; i < snrs_db.size(); ++i) {
        auto channel = CreateObject<SingleModelSpectrumChannel>();
        auto loss = CreateObject<FixedRssLossModel>();
        loss->SetRss(noise_dbm() + snrs_db[i]);
        channel->AddPropagationLossModel(loss);
        auto sender = add_device(channel, 1, Vector(0, 0, 0));
        auto receiver = add_device(channel, 2, Vector(1, 0, 0));
        int received = 0;
        receiver->GetPhy()->SetPdDataIndicationCallback(Callback<void, uint32_t, Ptr<Packet>, uint8_t>(
            [&received](uint32_t, Ptr<Packet>, uint8_t) { ++received; }));
        sender->GetPhy()->SetPdDataConfirmCallback(MakeNullCallback<void, LrWpanPhyEnumeration>());
        sender->GetPhy()->SetPlmeSetTRXStateConfirmCallback(MakeNullCallback<void, LrWpanPhyEnumeration>());
        receiver->GetPhy()->SetPlmeSetTRXStateConfirmCallback(MakeNullCallback<void, LrWpanPhyEnumeration>());
        /* The MACs, which wait for nothing here, have switched both receivers on by then. */
        Simulator::Schedule(MilliSeconds(5),
                            [&sender] { sender->GetPhy()->PlmeSetTRXStateRequest(IEEE_802_15_4_PHY_TX_ON); });
        for (int frame = 0; frame < frames; ++frame) {
            Simulator::Schedule(MilliSeconds(10 * (frame + 1)), [&sender, psdu_len] {
                sender->GetPhy()->PdDataRequest(psdu_len, Create<Packet>(psdu_len));
            });
        }
        Simulator::Run();
        Simulator::Destroy();
        std::printf("%s%d", i == 0 ? "" : ", ", received);
    }
    std::printf("]}\n");
    return 0;
}

struct Counts {
    bool counting = false;
    unsigned long acked = 0, unanswered = 0, blocked = 0;
};

/* When the last transmission of another device ended: all hear each other. */
class WholeCca
{
  public:
    void add(Ptr<LrWpanNetDevice> device)
    {
        const std::size_t own = ends_.size();
        ends_.push_back(Seconds(-1));
        auto phy = device->GetPhy();
        phy->TraceConnectWithoutContext(
            "PhyTxEnd", Callback<void, Ptr<const Packet>>([this, own](Ptr<const Packet>) { ends_[own] = Now(); }));
        phy->SetPlmeCcaConfirmCallback(
            Callback<void, LrWpanPhyEnumeration>([this, own, mac = device->GetMac()](LrWpanPhyEnumeration status) {
                mac->PlmeCcaConfirm(status == IEEE_802_15_4_PHY_IDLE && ended_within(own) ? IEEE_802_15_4_PHY_BUSY
                                                                                          : status);
            }));
    }

  private:
    bool ended_within(std::size_t but) const
    {
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            if (i != but && Now() - ends_[i] < MicroSeconds(128)) {
                return true;
            }
        }
        return false;
    }
    std::vector<Time> ends_;
};

int contend(int contenders, uint32_t psdu_len, double seconds, uint32_t seed, bool whole_cca)
{
    RngSeedManager::SetRun(seed);
    auto channel = CreateObject<SingleModelSpectrumChannel>();
    channel->AddPropagationLossModel(CreateObject<LogDistancePropagationLossModel>());
    channel->SetPropagationDelayModel(CreateObject<ConstantSpeedPropagationDelayModel>());
    std::vector<Ptr<LrWpanNetDevice>> devices = {add_device(channel, 1, Vector(0, 0, 0))};
    auto start = CreateObject<UniformRandomVariable>();
    Counts counts;
    uint32_t sent_len = 0;
    for (int i = 0; i < contenders; ++i) {
        const double angle = 2 * M_PI * i / contenders;
        auto device = add_device(channel, static_cast<uint16_t>(i + 2),
                                 Vector(kRadiusM * std::cos(angle), kRadiusM * std::sin(angle), 0));
        devices.push_back(device);
        auto mac = device->GetMac();
        const auto send = [mac, psdu_len] {
            mac->McpsDataRequest(request_to(1, true), Create<Packet>(psdu_len - kOverheadLen));
        };
        mac->SetMcpsDataConfirmCallback(
            Callback<void, McpsDataConfirmParams>([&counts, send](McpsDataConfirmParams confirm) {
                if (counts.counting) {
                    ++(confirm.m_status == IEEE_802_15_4_SUCCESS  ? counts.acked
                       : confirm.m_status == IEEE_802_15_4_NO_ACK ? counts.unanswered
                                                                  : counts.blocked);
                }
                Simulator::ScheduleNow(send);
            }));
        Simulator::Schedule(MicroSeconds(1000 + start->GetInteger(0, 100000)), send);
    }
    WholeCca cca;
    for (const auto &device : devices) {
        if (whole_cca) {
            cca.add(device);
        }
    }
    devices[1]->GetPhy()->TraceConnectWithoutContext(
        "PhyTxBegin",
        Callback<void, Ptr<const Packet>>([&sent_len](Ptr<const Packet> packet) { sent_len = packet->GetSize(); }));
    Simulator::Schedule(Seconds(1), [&counts] { counts.counting = true; });
    Simulator::Stop(Seconds(1 + seconds));
    Simulator::Run();
    Simulator::Destroy();
    std::printf("{\"acked\": %lu, \"unanswered\": %lu, \"blocked\": %lu, \"psdu_len\": %u}\n", counts.acked,
                counts.unanswered, counts.blocked, sent_len);
    return sent_len == psdu_len ? 0 : 1;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc > 4 && std::strcmp(argv[1], "per") == 0) {
        std::vector<double> snrs_db;
        for (int i = 4; i < argc; ++i) {
            snrs_db.push_back(std::atof(argv[i]));
        }
        return frame_errors(static_cast<uint32_t>(std::atoi(argv[2])), std::atoi(argv[3]), snrs_db);
    }
    if ((argc == 6 || argc == 7) && std::strcmp(argv[1], "contend") == 0) {
        return contend(std::atoi(argv[2]), static_cast<uint32_t>(std::atoi(argv[3])), std::atof(argv[4]),
                       static_cast<uint32_t>(std::atoi(argv[5])), argc == 7 && std::strcmp(argv[6], "cca") == 0);
    }
    std::fprintf(stderr, "ns3_radio: per PSDU_LEN FRAMES SNR_DB... | contend CONTENDERS PSDU_LEN SECONDS SEED [cca]\n");
    return 2;
}
