"""A browser draws the page without an error: every chart and table, light and dark, on a desk and on a phone, nothing wider than the screen."""
# SPDX-License-Identifier: Apache-2.0
import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_page import PAGE_SCENARIO
from run_site import check, emulate, skip

CHARTS = ("plan", "timeline", "energy-all", "energy-rest", "bytes", "map-bytes", "latency", "latency-hops", "error")
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
        check(not console, f"{width} px: {console}")
        for chart in CHARTS:
            drawn = re.search(rf'<div id="{chart}"><div><svg[^>]*aria-label="[^"]+"', dom)
            check(drawn is not None, f"{width} px: no chart {chart}")
        dom = re.sub(r"<script.*?</script>|data:image[^\"]*", "", dom, flags=re.DOTALL)
        check("NaN" not in dom and "undefined" not in dom, f"{width} px: not a number")
        check(dom.count("<table>") == dom.count("<details") >= len(CHARTS), f"{width} px: a chart has no table")
        tiles = dom.count('class="tile"')
        check(tiles == 8, f"{width} px: {tiles} tiles")
        check(f'{summary["totals"]["maps_received"]} <small>' in dom, f"{width} px: delivered maps are not there")
        wide = re.search(r'id="probe">(\d+) of (\d+)<', dom)
        check(wide is not None and int(wide[1]) <= int(wide[2]) == width, f"{width} px: the page is {wide and wide[0]} px wide")
    print(f"{len(CHARTS)} charts at 1400 and 390 px")
