/*
 * tarsier-sink: receives the maps of a site, stores them, and writes the cloud.
 *
 *   tarsier-sink site.toml --keys keys.toml --db sink.db --listen unix:/run/tarsier --out out
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "tsr/host/command_line.h"
#include "tsr/host/input_error.h"
#include "tsr/host/keys.h"
#include "tsr/host/site.h"
#include "tsr/sink/export.h"
#include "tsr/sink/gateway.h"
#include "tsr/sink/receiver.h"
#include "tsr/sink/site_event.h"

namespace
{

struct Options {
    std::filesystem::path site;
    std::filesystem::path keys;
    std::filesystem::path database;
    std::filesystem::path out;
    std::string listen;
    bool export_only = false;
    bool once = false;
    bool quiet = false;
};

void declare(CLI::App &app, Options &options)
{
    app.add_option("SITE", options.site, "site.toml")->required();
    app.add_option("--keys", options.keys, "key file, mode 0600");
    app.add_option("--db", options.database, "SQLite file; created if absent")->required();
    app.add_option("--listen", options.listen,
                   "unix:PATH, tcp:HOST:PORT, serial:DEVICE:BAUD, or fd:NUMBER, a connected socket");
    app.add_option("--out", options.out, "folder for cloud.ply, maps/ and sink.json")->required();
    app.add_flag("--export-only", options.export_only, "write --out from --db and stop");
    app.add_flag("--once", options.once, "stop when the last gateway has disconnected");
    app.add_flag("--quiet", options.quiet, "log warnings only");
}

void log_map(const tsr::MapReport &map)
{
    spdlog::info("map from node {} ({}): counter {}, {} + {} bytes, {}{}", map.node, map.pair, map.counter, map.map_len,
                 map.reference_len, map.kept ? "kept" : "dropped",
                 map.mse_px2 ? fmt::format(", MSE {:.4f} px^2", *map.mse_px2) : "");
}

void log_events(const tsr::EventReport &report)
{
    for (const tsr::StoredEvent &event : report.events.events) {
        spdlog::info("event from node {} ({}): {}", report.events.node, report.pair->name,
                     tsr::event_text(tsr::describe_event(*report.pair, event)));
    }
}

/* Everything that can be refused is read and opened before the database is made. */
struct Entrance {
    tsr::KeyRing keys;
    std::unique_ptr<tsr::Gateways> gateways;
};

Entrance open_entrance(const Options &options, const tsr::Site &site)
{
    Entrance entrance;
    entrance.keys = tsr::load_keys(options.keys);
    tsr::check_keys(entrance.keys, site, options.keys);
    const tsr::ListenAddress address = tsr::parse_listen_address(options.listen);
    if (entrance.keys.test && address.kind == tsr::ListenAddress::Kind::serial) {
        throw tsr::InputError(options.keys.string(), "test", "test keys are refused for a board on a serial port");
    }
    tsr::GatewayOptions gateway;
    gateway.once = options.once;
    gateway.log = [](const std::string &line) { spdlog::info("{}", line); };
    entrance.gateways = std::make_unique<tsr::Gateways>(address, gateway);
    return entrance;
}

tsr::SessionNumbers receive(Entrance &entrance, const tsr::Site &site, tsr::Store &store)
{
    tsr::Receiver receiver(site, entrance.keys, store);
    receiver.on_map(log_map);
    receiver.on_events(log_events);
    tsr::LinkServer server(receiver, site.pan_id);
    entrance.gateways->serve(server);
    return {receiver.tally(), server.counts(), receiver.repeated()};
}

/* The folder of the results: made at once, so that it is not refused after hours, and gone again if anything else is
 * refused. */
class OutFolder
{
  public:
    explicit OutFolder(const std::filesystem::path &folder) : folder_(folder)
    {
        std::error_code error;
        made_ = std::filesystem::create_directories(folder_, error);
        if (error) {
            throw tsr::InputError(folder_.string(), "--out", error.message());
        }
    }
    OutFolder(const OutFolder &) = delete;
    OutFolder &operator=(const OutFolder &) = delete;
    ~OutFolder()
    {
        std::error_code ignored;
        if (made_) {
            std::filesystem::remove(folder_, ignored); /* only an empty folder goes */
        }
    }

  private:
    std::filesystem::path folder_;
    bool made_ = false;
};

int run(const Options &options)
{
    spdlog::set_default_logger(spdlog::stderr_logger_st("tarsier-sink"));
    spdlog::set_pattern("%v");
    spdlog::set_level(options.quiet ? spdlog::level::warn : spdlog::level::info);
    if (!options.export_only && (options.listen.empty() || options.keys.empty())) {
        throw tsr::InputError("command line", "--listen and --keys", "are required without --export-only");
    }
    const tsr::Site site = tsr::load_site(options.site);
    std::optional<Entrance> entrance;
    if (!options.export_only) {
        entrance = open_entrance(options, site);
    }
    const OutFolder out(options.out);
    tsr::Store store(options.database, site.pan_id,
                     options.export_only ? tsr::Store::Open::existing : tsr::Store::Open::create);
    const tsr::SessionNumbers session = entrance ? receive(*entrance, site, store) : tsr::SessionNumbers{};
    const tsr::ExportResult result = tsr::export_site(site, store, session, options.out);
    spdlog::info("{} maps, {} events and a cloud of {} points written to {}", result.maps, result.events, result.points,
                 options.out.string());
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    return tsr::run_command_line({"tarsier-sink",
                                  "Receives the maps of a Tarsier site, stores them, and writes the cloud.",
                                  [&](CLI::App &app) { declare(app, options); }, [&] { return run(options); }},
                                 argc, argv);
}
