"""The radio medium agrees with ns-3's lr-wpan: packet error within 0.5 dB, CSMA throughput within 5 % (docs/radio.md)."""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys

TESTS = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS / "support"), str(TESTS / "bench")]
import radio_peers as peers
from run_site import BUILD, check, skip

PROGRAMS = BUILD / "bin"
FRAMES = 4000
SECONDS = 20
SEEDS = (11, 12)

if not (PROGRAMS / "ns3_radio").exists():
    skip("test_air_ns3", "libns3-dev is not installed")

for psdu_len in (20, 127):
    air, ns3 = (peers.packet_errors(PROGRAMS, name, psdu_len, FRAMES) for name in ("air_radio", "ns3_radio"))
    for level in peers.LEVELS:
        difference_db = peers.snr_at(air, level) - peers.snr_at(ns3, level)
        print(f"{psdu_len} octets, packet error {level}: {difference_db:+.2f} dB from ns-3")
        check(abs(difference_db) <= 0.5, f"{psdu_len} octets: {difference_db:.2f} dB from ns-3 at a packet error of {level}")

# With CCAs over their whole time on both sides, and with CCAs as ns-3.37 reads them.
for contenders in peers.CONTENDERS:
    for air_options, ns3_options in (((), ("cca",)), (("cca=end",), ())):
        air = peers.acknowledged_per_s(PROGRAMS, "air_radio", contenders, 60, SECONDS, SEEDS, *air_options)
        ns3 = peers.acknowledged_per_s(PROGRAMS, "ns3_radio", contenders, 60, SECONDS, SEEDS, *ns3_options)
        percent = 100 * (air / ns3 - 1)
        print(f"{contenders} contenders {' '.join(air_options)}: {air:.1f} frames a second, {percent:+.1f} % from ns-3")
        check(abs(percent) <= 5, f"{contenders} contenders: {percent:.1f} % from ns-3")
