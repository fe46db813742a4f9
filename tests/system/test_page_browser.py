"""A browser draws the page of a run, and that of a sweep, without an error: every chart and table, light and dark, on a desk and on a phone, nothing wider than the screen."""
# SPDX-License-Identifier: Apache-2.0
import csv
import html
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_page import PAGE_SCENARIO
from run_site import BUILD, check, emulate, skip

CHARTS = ("plan", "timeline", "energy-all", "energy-rest", "bytes", "map-bytes", "latency", "latency-hops", "error", "losses", "zone-chart-0")
OPEN_TABLES = 2  # faults and events of zones; all others are in a chart's details
DATA = re.compile(r'<script id="data" type="application/json">(.*?)</script>', re.DOTALL)
# The page in a frame, since a browser's window is not narrower than 500 px: opens every table, then shows what the frame has.
FRAME = """<!doctype html><body style="margin:0"><iframe width="%d" height="2000" style="border:0" srcdoc="%s"></iframe><script>
setTimeout(() => {
  const inside = document.querySelector("iframe").contentDocument;
  inside.querySelectorAll("details").forEach((one) => { one.open = true; });
  setTimeout(() => {
    const wide = `<p id="probe">${inside.documentElement.scrollWidth} of ${inside.defaultView.innerWidth}</p>`;
    document.documentElement.innerHTML = inside.documentElement.innerHTML + wide;
  }, 500);
}, 1500);
</script>"""


def browse(browser, page, *options):
    """The page's DOM once it stands still, and what the console said."""
    with tempfile.TemporaryDirectory() as profile:
        command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
                   "--disable-component-update", "--disable-sync", "--disable-quic", "--hide-scrollbars", "--enable-logging=stderr",
                   "--virtual-time-budget=4000", f"--user-data-dir={profile}", "--window-size=1600,2000", "--dump-dom", *options, page.as_uri()]
        result = subprocess.run(command, capture_output=True, text=True, timeout=300)
    return result.stdout, [line for line in result.stderr.splitlines() if "CONSOLE" in line]


def crowded(page):
    """The same page for a hundred nodes, with messages of a kind that is no map."""
    data = json.loads(DATA.search(page)[1])
    columns = {name: i for i, name in enumerate(data["nodes"]["columns"])}
    cameras = [row for row in data["nodes"]["rows"] if row[columns["role"]] == "binocular"]
    rows, episodes = data["nodes"]["rows"], data["episodes"]["rows"]
    for copy in range(1, 33):
        for row in cameras:
            more = list(row)
            more[columns["id"]] += 100 * copy
            more[columns["place_x_m"]] += 3 * copy
            rows.append(more)
        episodes += [[node + 100 * copy, *rest] for node, *rest in data["episodes"]["rows"][:20]]
    data["nodes"]["of"] = len(rows)
    data["messages"] = {"of": 1, "rows": [[12.5, 101, "depth event"]]}
    return DATA.sub(lambda found: found[0].replace(found[1], json.dumps(data).replace("<", "\\u003c")), page), len(rows)


def check_clean(dom, console, width):
    """Nothing failed, and nothing is wider than the screen; returns what is to be seen."""
    check(not console, f"{width} px: {console[:3]}")
    dom = re.sub(r"<script.*?</script>|data:image[^\"]*", "", dom, flags=re.DOTALL)
    check("NaN" not in dom and "undefined" not in dom, f"{width} px: not a number")
    wide = re.search(r'id="probe">(\d+) of (\d+)<', dom)
    check(wide is not None and int(wide[1]) <= int(wide[2]) == width, f"{width} px: the page is {wide and wide[0]} px wide")
    return dom


def check_drawn(dom, console, width, charts):
    dom = check_clean(dom, console, width)
    for chart in charts:
        drawn = re.search(rf'<div id="{chart}"><div><svg[^>]*aria-label="[^"]+"', dom)
        check(drawn is not None, f"{width} px: no chart {chart}")
    details = dom.count("<details")
    check(dom.count("<table>") == details + OPEN_TABLES and details >= 10, f"{width} px: a chart has no table")
    check("camera failure of pair 2" in dom and re.search(r"<td[^>]*>camera failure</td>", dom), f"{width} px: the fault is not told")
    check(dom.count('class="dash"') == 4 * dom.count("<figure>") > 0, f"{width} px: zones are not drawn")
    tiles = dom.count('class="tile"')
    check(tiles == 8, f"{width} px: {tiles} tiles")
    return dom


def check_sweep(browser, scenario, folder):
    """A chart of each figure that differs, a point for each run, a row with a link for each."""
    out = folder / "sweep"
    words = [BUILD / "bin/tarsier-emulator", scenario, "--out", out, "--quiet", "--sweep", "pairs.baseline_mm=60,90,120", "--sweep", "pairs.count=2,3"]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    framed = folder / "framed.html"
    for width in (1400, 390):
        framed.write_text(FRAME % (width, html.escape((out / "index.html").read_text())))
        dom = check_clean(*browse(browser, framed), width)
        for figure in ("air_bytes", "error_median_px", "node_energy_mj_total"):
            chart = re.search(rf'<div id="figure-{figure}"><div><svg.*?</svg>', dom, re.DOTALL)
            check(chart is not None and chart[0].count("<circle") == 6 and chart[0].count("<path") == 2, f"{width} px: no lines of {figure}")
        links = re.findall(r'href="(runs/\d+/index.html)"', dom)
        check(len(links) == 6 and all((out / link).exists() for link in links), f"{width} px: links {links}")
        check("pairs.count = 3" in dom, f"{width} px: a line has no name")
        figures = re.findall(r'id="figure-(\w+)"', dom)
        others = [i for i, name in enumerate(figures) if not re.match("maps_received|error_|matched|correct", name)]
        check("error_median_px" in figures[:others[0]], f"{width} px: errors are not first in {figures}")


def check_seeds(browser, scenario, folder):
    """Seeds are no lines: a point is their mean, with whiskers."""
    out = folder / "seeds"
    words = [BUILD / "bin/tarsier-emulator", scenario, "--out", out, "--quiet", "--sweep", "seed=1,2,3", "--sweep", "pairs.baseline_mm=60,90"]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    rows = [row for row in csv.DictReader((out / "sweep.csv").open(newline=""))]
    check(len(rows) == 6, f"{len(rows)} rows: one for each run")
    means = [statistics.mean(float(row["air_bytes"]) for row in rows if row["pairs.baseline_mm"] == value) for value in ("60", "90")]
    framed = folder / "framed.html"
    for width in (1400, 390):
        framed.write_text(FRAME % (width, html.escape((out / "index.html").read_text())))
        dom = check_clean(*browse(browser, framed), width)
        chart = re.search(r'<div id="figure-air_bytes"><div><svg.*?</svg>', dom, re.DOTALL)
        check(chart is not None and chart[0].count("<circle") == 2 and chart[0].count('class="whisker"') == 2, f"{width} px: no mean over seeds")
        shown = [float(value.replace(",", "")) for value in re.findall(r"mean ([0-9.,]+) of 3 seeds", chart[0])]
        check(all(abs(one / mean - 1) < 0.01 for one, mean in zip(shown, means, strict=True)), f"{width} px: means {shown}, in the table {means}")
        check("mean over 3 seeds, whiskers: least to largest" in dom, f"{width} px: nothing says what the whiskers are")


browser = shutil.which("chromium")
if browser is None:
    skip("test_page_browser", "chromium is not installed")
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    broken = folder / "broken.html"
    broken.write_text("<!doctype html><script>nobody();</script>")
    check(len(browse(browser, broken)[1]) == 1, "an error in a page would not be seen")

    scenario = folder / "page.toml"
    scenario.write_text(PAGE_SCENARIO)
    summary = emulate(scenario, folder / "out")
    page = (folder / "out/index.html").read_text()
    framed = folder / "framed.html"
    for width, options in ((1400, ()), (390, ()), (390, ("--blink-settings=preferredColorScheme=0",))):
        framed.write_text(FRAME % (width, html.escape(page)))
        dom, console = browse(browser, framed, *options)
        dom = check_drawn(dom, console, width, CHARTS)
        check(f'{summary["totals"]["maps_received"]} <small>' in dom, f"{width} px: delivered maps are not there")
    page, count = crowded(page)
    for width in (1400, 390):
        framed.write_text(FRAME % (width, html.escape(page)))
        dom = check_drawn(*browse(browser, framed), width, (*CHARTS, "life"))
        check(f"{count} nodes" in dom and "diamonds: depth event" in dom, f"{width} px: {count} nodes and their messages are not there")
    check_sweep(browser, scenario, folder)
    check_seeds(browser, scenario, folder)
    print(f"{len(CHARTS)} charts at 1400 and 390 px")
