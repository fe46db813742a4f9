"""Flash, RAM and stack of tarsier-node.elf: from the linker's map, the compiler's call graph and a run. Not a test.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import re
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/target"))
import board  # noqa: E402

IMAGE = "tarsier-node"
FLASH_END, RAM_START, RAM_END = 0x400000, 0x20000000, 0x21000000
LAYERS = ("base", "vision", "codec", "wire", "net", "node")

# Whom a call through a pointer may reach, by the function or else the file that makes it: what this image binds.
CLOCK = "tsr_mps2_clock_now_us"
INDIRECT = {
    "mps2/loopback.c:transmit": (CLOCK,),
    "mps2/camera.c:capture": (CLOCK,),
    "vision/match.c": ("match_dsp_rows.c:tsr_dsp_prefilter_row", "match_dsp_rows.c:tsr_dsp_add_row",
                       "match_dsp.c:match_row", "match_prefilter.c:tsr_match_prefilter_row",
                       "match_columns.c:tsr_match_add_row", "match_kernels.c:move_and_finish"),
    "vision/match_kernels.c": (),
    "codec/map.c": ("map_encode_row.c:tsr_map_encode_row",),
    "codec/map_trace_row.c": (),  # not in the image
    "codec/map_trace_reference_row.c": (),
    "codec/packet.c": (),  # not in the image, as packets are not
    "codec/packet_pixels.c": (),
    "wire/ccm.c": ("aes.c:expand", "aes.c:encrypt"),
    "net/mac.c": ("loopback.c:configure", "loopback.c:set_receiving", "loopback.c:transmit",
                  "mps2_an386.c:fill_random"),
    "node/watch.c": ("camera.c:capture",),
    "node/uplink.c": ("uart.c:write_port",),
    "mps2/camera.c": (CLOCK, "mps2_an386.c:on_camera"),
    "mps2/loopback.c": (CLOCK, "mps2_an386.c:on_radio"),
    "library/platform_util.c": ("memset",),
}
# Functions of nothing but assembly, of which the compiler tells neither frame nor calls: what they push, and whom they
# call.
ASSEMBLY = {
    "tsr_dsp_match_pixels": (468, ("tsr_dsp_begin", "tsr_dsp_prepare")),
    "match_dsp_rows.c:filter_quads": (36, ()),
    "match_dsp_rows.c:filter_quads_mirrored": (36, ()),
}
LIBRARY_FRAME_LEN = 64  # assumed of newlib's and libgcc's functions, whose frames the compiler does not tell


def owner(path):
    """The layer or part that an object file of the map belongs to."""
    layer = re.search(r"libtsr_(\w+)\.a", path)
    if layer:
        return {"hal_mps2": "hal/mps2", "mbedtls_aes": "Mbed TLS (AES)"}.get(layer[1], layer[1])
    if "firmware/app" in path:
        return "hal/mps2" if "start.c" in path else "app"
    return "newlib, libgcc"


def sections(map_file):
    """(section, address, length, object file) of everything that the linker has kept."""
    text = pathlib.Path(map_file).read_text("utf-8")
    text = text[text.index("Linker script and memory map"):]
    pattern = r"(?m)^ (\.[\w.$-]+|COMMON)\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S.*)$"
    for match in re.finditer(pattern, text):
        if int(match[3], 16) > 0:
            yield match[1], int(match[2], 16), int(match[3], 16), match[4]


def sizes(bin_folder):
    """{owner: {"flash": bytes, "ram": bytes}}; external memory and the stack are not in it."""
    found = {}
    for section, address, length, path in sections(bin_folder / f"{IMAGE}.map"):
        if section.startswith((".debug", ".comment", ".ARM.attributes", ".lab")):
            continue
        entry = found.setdefault(owner(path), {"flash": 0, "ram": 0})
        if RAM_START <= address < RAM_END:
            entry["ram"] += length
            if section.startswith(".data"):
                entry["flash"] += length
        elif address < FLASH_END:
            entry["flash"] += length
    return found


def totals(bin_folder):
    """Bytes per output section of the image."""
    text = board.run(["arm-none-eabi-size", "-A", bin_folder / f"{IMAGE}.elf"])
    found = dict(re.findall(r"(?m)^(\.\w+)\s+(\d+)", text))
    length = {name: int(value) for name, value in found.items()}
    return {"flash": length[".text"] + length[".data"] + length.get(".ARM", 0),
            "stack": length[".stack"], "static": length[".data"] + length[".bss"],
            "ram": length[".stack"] + length[".data"] + length[".bss"]}


class CallGraph:
    """Frames and calls of the functions that an image is made of, as gcc -fcallgraph-info=su tells them."""

    def __init__(self, build_folder):
        self.frame, self.calls, self.file = {}, {}, {}
        for path in sorted(pathlib.Path(build_folder).rglob("*.ci")):
            if any(part in str(path) for part in ("CompilerId", "tests/target", "unity")):
                continue
            self.read(path.read_text("utf-8"))
        for suffix, (frame, calls) in ASSEMBLY.items():
            name = next(title for title in self.frame if title == suffix or title.endswith("/" + suffix))
            self.frame[name] = frame
            self.calls.setdefault(name, set()).update(calls)

    def read(self, text):
        source = re.match(r'graph: \{ title: "([^"]*)"', text)[1]
        for title, label in re.findall(r'node: \{ title: "([^"]*)" label: "([^"]*)"', text):
            size = re.search(r"\\n(\d+) bytes \((\w+)", label)
            if size:
                if size[2] != "static":
                    raise board.BoardError(f"{title}: a frame of {size[2]} size")
                self.frame[title] = int(size[1])
                self.file[title] = source
        for caller, callee in re.findall(r'edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"', text):
            self.calls.setdefault(caller, set()).add(callee)

    def callees(self, name):
        for callee in sorted(self.calls.get(name, ())):
            if callee != "__indirect_call":
                yield callee
                continue
            suffix = next((key for key in INDIRECT if name.endswith(key) or self.file[name].endswith(key)), None)
            if suffix is None:
                raise board.BoardError(f"{name} calls through a pointer: name its targets in INDIRECT")
            for target in INDIRECT[suffix]:
                yield next((title for title in self.frame if title.endswith("/" + target)), target)

    def deepest(self, name, path=(), known=None):
        """(bytes, [functions]) of the deepest chain of calls from name."""
        known = {} if known is None else known
        if name in path:
            raise board.BoardError(f"recursion: {' > '.join(path[path.index(name):] + (name,))}")
        if name not in known:
            below = [self.deepest(callee, path + (name,), known) for callee in self.callees(name)]
            depth, chain = max(below, default=(0, []))
            known[name] = (depth + self.frame.get(name, LIBRARY_FRAME_LEN), [name, *chain])
        return known[name]


def short(function):
    return function.rsplit(":", 1)[-1]


def stack_bound():
    """(bytes, [functions]) of the image's deepest chain of calls, from reset. Fails if the graph has a cycle."""
    return CallGraph(board.BOARD_BUILD).deepest("tsr_mps2_reset")


def stack_by_layer():
    """Deepest chain from any public function of each layer, with what it calls in others."""
    graph, known, found = CallGraph(board.BOARD_BUILD), {}, {}
    for name in sorted(graph.frame):
        layer = re.search(r"firmware/(\w+)/[^/]*$", graph.file[name])
        if layer and layer[1] in LAYERS and name.startswith("tsr_"):
            depth, chain = graph.deepest(name, (), known)
            if depth > found.get(layer[1], (0, []))[0]:
                found[layer[1]] = (depth, chain)
    return found
