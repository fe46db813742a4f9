"""The same seed gives the same bytes; another seed gives others."""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, emulate, make_scene, results


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
