"""Energy and battery life in summary.json, recomputed from docs/energy.md's equations and the run's own site.toml."""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys
import tempfile
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, emulate, make_scene

STATES = {"radio": ("transmit", "assess", "acknowledge", "receive", "sleep"), "cpu": ("run", "sleep"),
          "camera": ("start", "expose", "read", "standby"), "storage": ("write", "read", "standby"),
          "board": ("leakage",)}
YEAR_H = 8766
MJ_PER_INSTRUCTION = 1.3 / 64e6 * 52e-3 * 64 * 3.0  # cycles / clock x current at it, mA, x V


def near(a, b, relative, absolute=0.0):
    return abs(a - b) <= absolute + relative * abs(b)


def life_days(battery, mean_uw):
    """Equation (2)."""
    full_mwh = battery["capacity_mah"] * battery["voltage_v"]
    drawn_uw = (mean_uw / battery["converter_efficiency_percent"] * 100 +
                battery["voltage_v"] * battery["converter_quiescent_ua"])
    lost_uw = full_mwh * 1000 * battery["self_discharge_percent_year"] / 100 / YEAR_H
    return full_mwh * battery["usable_percent"] / 100 / (drawn_uw + lost_uw) * 1000 / 24


def check_node(node, battery, seconds):
    name, energy = node["name"], node["energy_mj"]
    check({part: tuple(energy[part]) for part in STATES} == STATES, f"{name}: other states: {energy}")
    states = [energy[part][state] for part in STATES for state in STATES[part]]
    check(min(states) >= 0, f"{name}: a state gains energy")
    check(near(sum(states), energy["total"], 0, 0.01), f"{name}: {sum(states)} mJ in states, {energy['total']} in all")
    instructions = sum(work["instructions"] for work in node["work"].values())
    # A step takes whole microseconds, rounded down but at least one, which moves sums of short steps.
    check(near(energy["cpu"]["run"], instructions * MJ_PER_INSTRUCTION, 0.1, 0.1),
          f"{name}: {energy['cpu']['run']} mJ of work for {instructions} instructions")
    mean_uw = energy["total"] / seconds * 1000
    check(near(node["battery"]["mean_power_uw"], mean_uw, 1e-5), f"{name}: mean power is not {mean_uw} uW")
    days = life_days(battery, mean_uw)
    check(near(node["battery"]["life_days"], days, 1e-4, 0.01),
          f"{name}: {node['battery']['life_days']} days, not {days}")


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    site = make_scene("test_energy_summary", folder / "scene")
    summary = emulate(site, folder / "out")
    battery = tomllib.loads((folder / "out/site.toml").read_text("utf-8"))["battery"]
    for node in summary["nodes"]:
        check_node(node, battery, summary["virtual_time_s"])
        print(f"{node['name']}: {node['battery']['mean_power_uw'] / 1000:.2f} mW, {node['battery']['life_days']} days")
    roles = {node["role"]: node["energy_mj"]["camera"] for node in summary["nodes"]}
    check(sum(roles["relay"].values()) == 0, "a relay pays for a camera")
    check(all(cost > 0 for cost in roles["lead"].values()), "a lead has a camera state that costs nothing")
    total = sum(node["energy_mj"]["total"] for node in summary["nodes"])
    check(near(summary["totals"]["energy_mj"], total, 1e-6), "the total is not the nodes'")
