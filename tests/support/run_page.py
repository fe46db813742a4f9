"""A run for its page, and the data in the page."""
# SPDX-License-Identifier: Apache-2.0
import json
import re

# Three binocular pairs whose level rises: maps, withheld ones, events of their zones, a fault; a name that HTML and CSV must quote.
PAGE_SCENARIO = """
name = 'page <b>"1"</b>, &'
duration_s = 40
[scene]
kind = "tank"
level_step_m = 0.5
level_rate_m_s = 0.1
[pairs]
count = 3
width = 96
height = 72
baseline_mm = 150
disparities = 24
[thresholds]
similarity_px2 = 0.5
similarity_blocks = 1
[[zone]]
name = "surface"
rectangle = [40, 36, 18, 12]
changed_by_m = 0.1
area_percent = 70
every_s = 1
[[fault]]
at_s = 20
kind = "camera failure"
node = 2
for_s = 4
"""


def page_data(out):
    """What index.html in out has embedded."""
    text = (out / "index.html").read_text()
    return json.loads(re.search(r'<script id="data" type="application/json">(.*?)</script>', text, re.DOTALL).group(1))
