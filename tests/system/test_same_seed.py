"""The same seed gives the same bytes; another seed gives others."""
# SPDX-License-Identifier: Apache-2.0
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, emulate, make_scene


def results(out):
    files = {name: (out / name).read_bytes() for name in ("cloud.ply", "capture.pcapng", "sink.json", "nodes.csv", "links.csv", "maps.csv")}
    files.update({f"maps/{file.name}": file.read_bytes() for file in (out / "maps").iterdir()})
    summary = json.loads((out / "summary.json").read_text())
    del summary["wall_time_s"]
    files["summary.json"] = json.dumps(summary).encode()
    return files


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    site = make_scene("test_same_seed", folder / "scene")
    make_scene("test_same_seed", folder / "again")
    for file in sorted((folder / "scene").rglob("*.*")):
        again = folder / "again" / file.relative_to(folder / "scene")
        check(file.is_dir() or file.read_bytes() == again.read_bytes(), f"{file.name}: the scene differs")
    emulate(site, folder / "first")
    emulate(site, folder / "second")
    emulate(site, folder / "other", "--seed", "2")
    first, second = results(folder / "first"), results(folder / "second")
    check(first.keys() == second.keys(), "other files")
    for name, content in first.items():
        check(content == second[name], f"{name} differs between two runs of one seed")
    check(first["capture.pcapng"] != results(folder / "other")["capture.pcapng"], "the seed changes nothing")
    print(f"{len(first)} files equal")
