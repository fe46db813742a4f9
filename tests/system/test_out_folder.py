"""Whatever ends a run early, the results of the run before stay; complete ones replace them all, and nothing else is left."""
# SPDX-License-Identifier: Apache-2.0
import hashlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, child_named, emulate, make_scene, start_emulator

EMULATOR = BUILD / "bin/tarsier-emulator"
SCENARIO = """name = "tank"
duration_s = 10
[scene]
kind = "tank"
[pairs]
count = 1
width = 64
height = 48
"""


def contents(out):
    """Digest of every result by name."""
    files = {str(file.relative_to(out)): hashlib.sha256(file.read_bytes()).hexdigest()
             for file in sorted(out.rglob("*")) if file.is_file()}
    return {name: digest for name, digest in files.items() if not {"tarsier-run", "unfinished"} & set(pathlib.Path(name).parts)}


def script(folder, name, body):
    file = folder / name
    file.write_text(f"#!/bin/sh\n{body}\n")
    file.chmod(0o755)
    return file


def refused(what, out, site, *options, says):
    """The run ends with status 2 and one line that says why, and out is as it was."""
    before = contents(out)
    run = subprocess.run([EMULATOR, site, f"--out={out}", "--quiet", *options], capture_output=True, text=True,
                         errors="replace")
    check(run.returncode == 2 and len(run.stderr.splitlines()) == 1 and says in run.stderr,
          f"{what}: {run.returncode}: {run.stderr}")
    after = contents(out)
    check(after == before, f"{what}: changed {set(before.items()) ^ set(after.items())}")
    print(f"{what}: {run.stderr.strip()}")


def refusals(folder, site, out):
    refused("no sink", out, site, "--sink", folder / "none", says="none: run: No such file")
    refused("a sink that is no program", out, site, "--sink", site, says="run: Permission denied")
    refused("a sink that ends", out, site, "--sink", "/bin/true", says="/bin/true: run: does not answer")
    refuses = script(folder, "refuses", "echo first; echo 'sink: keys.toml: mode: no'; exit 2")
    refused("a sink that refuses", out, site, "--sink", refuses, says="sink: keys.toml: mode: no")
    frames = out / "maps/frames"
    shutil.copytree(site.parent / "left160", frames)
    text = site.read_text().replace('frames = "left160"', f'frames = "{frames}"')
    moved = site.with_name("moved.toml")
    moved.write_text(text)
    refused("frames among the results", out, moved, says="is among the results of an earlier run")


def names(folder, site):
    """Folders and files of any name."""
    emulate(site, folder / ("d" * 100) / ("e" * 100))
    run = subprocess.run([EMULATOR, site, "--out=-rel", "--quiet"], cwd=folder, capture_output=True, text=True)
    check(run.returncode == 0 and (folder / "-rel/summary.json").exists(), f"--out=-rel: {run.stderr}")
    odd = os.fsencode(folder) + b"/sc\xffne"
    shutil.copytree(os.fsencode(site.parent), odd)
    scenario = os.fsencode(folder) + b"/s\xff.toml"
    with open(scenario, "w", encoding="utf-8") as file:
        file.write(SCENARIO)
    # What frames' folders are called stands in OUT/site.toml, and TOML is UTF-8.
    for out, path, status in ((b"/o\xff1", odd + b"/site.toml", 2), (b"/o\xff2", scenario, 0)):
        run = subprocess.run([EMULATOR, path, "--out", os.fsencode(folder) + out, "--quiet"], capture_output=True)
        check(run.returncode == status, f"{path}: {run.returncode}: {run.stderr!r}")
    summary = json.loads(pathlib.Path(os.fsdecode(os.fsencode(folder) + b"/o\xff2/summary.json")).read_text("utf-8"))
    check(summary["settings"]["scenario"] == "s\ufffd.toml", f"{summary['settings']}")


def scenarios(folder):
    """What a run or a sweep reads is not among what it replaces."""
    scenario, out, words = folder / "tank.toml", folder / "swept", ["--sweep", "seed=1,2"]
    scenario.write_text(SCENARIO)
    subprocess.run([EMULATOR, scenario, "--out", out, "--quiet", *words], check=True, stdout=subprocess.DEVNULL)
    refused("a run's own scenario in a sweep", out, out / "runs/1/scenario.toml", says="is among the results")
    refused("a sweep of one of its scenarios", out, out / "runs/1/scenario.toml", *words, says="is among the results")
    crowd = folder / "crowd.toml"
    crowd.write_text('name = "crowd"\nduration_s = 10\n[recorded]\nsite = "played/site.toml"\n[pairs]\ncount = 2\n')
    subprocess.run([BUILD / "bin/tarsier", "render", scenario, "--out", folder / "frames"], check=True, stdout=subprocess.DEVNULL)
    played = folder / "played"
    emulate(folder / "frames/site.toml", played)
    for more in ([], words):
        refused(f"a crowd of results {more}", played, crowd, *more, says="is among the results")


def wait_for(what, condition):
    for _ in range(1000):
        result = condition()
        if result:
            return result
        time.sleep(0.01)
    check(False, f"waited in vain for {what}")


def gone(pid):
    """Also one that nobody has asked for its status."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def killed(folder, site, out):
    """The emulator is killed: its sink ends, nothing is lost, and the next run removes what it left."""
    before = contents(out)
    emulator = start_emulator(site, out, "--speed", "1")
    sink = wait_for("the sink", lambda: child_named(emulator.pid, "tarsier-sink"))
    time.sleep(0.2)
    emulator.kill()
    emulator.wait()
    wait_for("the orphan's end", lambda: gone(sink))
    check(contents(out) == before, "a killed run changed the results of the run before")
    emulate(site, out)
    left = [file for file in out.rglob("*") if file.name == "unfinished" or file.name.startswith(".")]
    check(not left, f"left behind: {left}")


def orphans_hold_the_folder(folder, site, out):
    """A sink that outlives its emulator may still write: nobody else may, in a sweep's folder either."""
    scenario = folder / "tank.toml"
    for what, path, words, log in (("an orphan", site, [], "unfinished/sink.log"),
                                   ("an orphan of a sweep", scenario, ["--sweep", "seed=1,2"], "runs/1/unfinished/sink.log")):
        target, go_on = out if path == site else folder / "swept", folder / f"go on {what}"
        stays = script(folder, "stays", f"{BUILD}/bin/tarsier-sink \"$@\"\nwhile [ ! -e '{go_on}' ]; do sleep 0.05; done")
        emulator = start_emulator(path, target, "--speed", "1", "--sink", stays, *words)
        wait_for("the sink", lambda: (target / log).exists() and "listening" in (target / log).read_text())
        emulator.kill()
        emulator.wait()
        refused(what, target, path, *words, says="another run writes there")
        go_on.touch()
        wait_for("the orphan's end", lambda: subprocess.run([EMULATOR, path, "--out", target, "--quiet", *words],
                                                            capture_output=True).returncode == 0)


def signals(folder, site, out):
    """A sink that does not answer does not keep a run that is to end."""
    before = contents(out)
    silent = script(folder, "silent", "exec sleep 60")
    emulator = subprocess.Popen([EMULATOR, site, "--out", out, "--quiet", "--sink", silent], stderr=subprocess.PIPE,
                                text=True)
    wait_for("the sink", lambda: child_named(emulator.pid, "sleep"))
    emulator.send_signal(signal.SIGINT)
    error = emulator.communicate(timeout=30)[1]
    check(emulator.returncode == 2 and "does not answer" in error, f"{emulator.returncode}: {error}")
    check(contents(out) == before, "a run whose sink is silent changed the results of the run before")

    emulator = start_emulator(site, out, "--sink", silent)
    sink = wait_for("the sink", lambda: child_named(emulator.pid, "sleep"))
    emulator.send_signal(signal.SIGINT)
    emulator.send_signal(signal.SIGINT)
    time.sleep(1.3)
    check(emulator.poll() is None, "the same signal again, at once, ended the program")
    emulator.send_signal(signal.SIGINT)
    check(emulator.wait(timeout=3) == -signal.SIGINT, f"a second Ctrl-C: {emulator.returncode}")
    os.kill(sink, signal.SIGKILL)


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    site = make_scene("test_out_folder", folder / "scene")
    out = folder / "out"
    emulate(site, out)
    refusals(folder, site, out)
    names(folder, site)
    scenarios(folder)
    killed(folder, site, out)
    orphans_hold_the_folder(folder, site, out)
    signals(folder, site, out)
