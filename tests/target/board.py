"""Build and run images for boards in QEMU. Not a test: what tests and benchmarks of the boards share.

The board is mps2-an386 (Cortex-M4) unless a machine is named.

TSR_SOURCE is the source tree (by default the one this file is in), TSR_BUILD the host's build tree.

SPDX-License-Identifier: Apache-2.0
"""
import contextlib
import fcntl
import os
import pathlib
import shutil
import subprocess
import sys

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
HOST_BUILD = pathlib.Path(os.environ.get("TSR_BUILD", SOURCE / "build/release"))
DEFAULT = "mps2-an386"
M55 = "mps3-an547"
BOARD_BUILD = SOURCE / "build" / DEFAULT
UNITY = pathlib.Path(os.environ.get("UNITY_DIR") or SOURCE / ".deps/unity")
MBEDTLS = pathlib.Path(os.environ.get("MBEDTLS_DIR") or SOURCE / ".deps/mbedtls")
LIBJPEG = pathlib.Path(os.environ.get("LIBJPEG_DIR") or SOURCE / ".deps/libjpeg-turbo")
TOOLS = ("cmake", "ninja", "arm-none-eabi-gcc", "arm-none-eabi-nm", "qemu-system-arm", "cc")
EXIT_SKIPPED = 77
MARKERS = ("workbench_begin", "workbench_stop")


class BoardError(Exception):
    pass


class Missing(Exception):
    """What a machine has not got: a reason to skip."""


def main(name, test):
    """Run a test function; the process ends with 0, 1, or 77 and the skip line."""
    try:
        test()
    except Missing as missing:
        print(f"tarsier skipped: {name}: {missing}")
        sys.exit(EXIT_SKIPPED)
    except (BoardError, AssertionError) as error:
        print(f"FAILED {name}: {error}")
        sys.exit(1)
    print(f"passed {name}")


def need_tools(*more):
    for tool in TOOLS + more:
        if shutil.which(tool) is None:
            raise Missing(f"{tool} is not installed")
    if not (MBEDTLS / "library/aes.c").exists():
        raise Missing(f"no Mbed TLS sources in {MBEDTLS}; run tools/setup test")


def need_libjpeg():
    if not (LIBJPEG / "jchuff.c").exists():
        raise Missing(f"no libjpeg-turbo sources in {LIBJPEG}; run tools/setup test")


def run(words, timeout_s=300, cwd=None):
    """Standard output of a command that must succeed."""
    try:
        done = subprocess.run([str(word) for word in words], cwd=cwd, capture_output=True, text=True,
                              timeout=timeout_s, check=False)
    except subprocess.TimeoutExpired as expired:
        raise BoardError(f"{words[0]}: not done after {timeout_s} s") from expired
    if done.returncode != 0:
        raise BoardError(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


@contextlib.contextmanager
def build_lock(machine=DEFAULT):
    """Tests run in parallel; one builds."""
    (SOURCE / "build").mkdir(exist_ok=True)
    with open(SOURCE / f"build/{machine}.lock", "w", encoding="ascii") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def build(*targets, machine=DEFAULT):
    """Build a board's images (all, or some targets); the folder of the images."""
    need_tools()
    folder = SOURCE / "build" / machine
    with build_lock(machine):
        if not (folder / "build.ninja").exists():
            run(["cmake", "--preset", machine], cwd=SOURCE)
        words = ["cmake", "--build", folder]
        run(words + (["--target", *targets] if targets else []), timeout_s=600)
    return folder / "bin"


def build_plugin():
    """The instruction counter as a QEMU plugin."""
    source, library = SOURCE / "tests/target/icount.c", BOARD_BUILD / "libicount.so"
    with build_lock():
        BOARD_BUILD.mkdir(exist_ok=True)
        if not library.exists() or library.stat().st_mtime < source.stat().st_mtime:
            run(["cc", "-O2", "-Wall", "-Wextra", "-shared", "-fPIC", "-o", library, source])
    return library


def build_on_host(program):
    """A board's program for the host, from the same sources; with sanitizers, so that the comparison also checks memory."""
    need_tools()
    with build_lock("asan"):
        if not (SOURCE / "build/asan/build.ninja").exists():
            run(["cmake", "--preset", "asan"], cwd=SOURCE)
        run(["cmake", "--build", SOURCE / "build/asan", "--target", program], timeout_s=600)
    return SOURCE / "build/asan/bin" / program


def run_image(image, words=(), cwd=None, timeout_s=120, options=(), machine=DEFAULT):
    """Run an image to its end: exit code and console text."""
    command = ["qemu-system-arm", "-M", machine, "-accel", "tcg", "-display", "none", "-monitor", "none",
               "-semihosting-config", ",".join(["enable=on", "target=native", f"arg={pathlib.Path(image).stem}",
                                                *[f"arg={word}" for word in words]]),
               "-kernel", str(image), *map(str, options)]
    if "-serial" not in options:
        command += ["-serial", "null"]
    try:
        done = subprocess.run(command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=timeout_s, check=False)
    except subprocess.TimeoutExpired as expired:
        raise BoardError(f"{image}: not done after {timeout_s} s; so far: {expired.output}") from expired
    return done.returncode, done.stdout


def address_of(image, symbol):
    for line in run(["arm-none-eabi-nm", image]).splitlines():
        if line.split()[-1] == symbol:
            return int(line.split()[0], 16)
    raise BoardError(f"{image}: no {symbol}")


def count_work(image, words, cwd, timeout_s=300, machine=DEFAULT):
    """Run the workbench with the counter: a list of (work, units, instructions)."""
    begin, end = (address_of(image, marker) for marker in MARKERS)
    counts = pathlib.Path(cwd) / "counts.txt"
    plugin = f"{build_plugin()},begin={begin:#x},end={end:#x},out={counts}"
    code, text = run_image(image, words, cwd, timeout_s, ("-plugin", plugin), machine)
    if code != 0:
        raise BoardError(f"{image}: exit {code}: {text}")
    work = [line.split() for line in (pathlib.Path(cwd) / "work.txt").read_text("ascii").splitlines()]
    instructions = [int(line) for line in counts.read_text("ascii").splitlines() if not line.startswith("total")]
    if len(work) != len(instructions):
        raise BoardError(f"{image}: {len(work)} kinds of work but {len(instructions)} counts")
    return [(name, int(units), count) for (name, units), count in zip(work, instructions)]
