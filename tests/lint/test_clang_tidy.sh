#!/usr/bin/env bash
# clang-tidy finds nothing; by default in the firmware, with tools/test --all in all of the product.
set -euo pipefail
cd "$TSR_SOURCE"
command -v clang-tidy >/dev/null || { echo "tarsier skipped: test_clang_tidy: clang-tidy is not installed"; exit 77; }
folders=(firmware/base firmware/wire firmware/net firmware/node firmware/codec firmware/vision)
commands=$TSR_BUILD
if [ "${TSR_TEST_ALL:-0}" = 1 ]; then
    folders+=(hal/air hal/recorded emulator sink tools)
    commands=$TSR_BUILD/tidy # every source by itself
    cmake --preset release -B "$commands" -D CMAKE_UNITY_BUILD=OFF >/dev/null
fi
find "${folders[@]}" -name '*.c' -o -name '*.cpp' | sort |
    xargs -P 2 -n 4 clang-tidy --quiet -p "$commands" 2>/dev/null
