#!/usr/bin/env bash
# cppcheck finds nothing in the product's C and C++.
set -euo pipefail
cd "$TSR_SOURCE"
command -v cppcheck >/dev/null || { echo "tarsier skipped: test_cppcheck: cppcheck is not installed"; exit 77; }
includes=()
for folder in firmware/*/include hal/include hal/*/include tools/*/include emulator/include sink/include; do
    includes+=(-I "$folder")
done
cppcheck --quiet --error-exitcode=1 --inline-suppr --enable=warning,performance,portability --std=c11 --language=c \
    --suppress=missingInclude "${includes[@]}" firmware
cppcheck --quiet --error-exitcode=1 --inline-suppr --enable=warning,performance,portability --std=c++20 --language=c++ \
    --suppress=missingInclude --suppress=syntaxError:*/node_state.h "${includes[@]}" hal/air hal/recorded emulator sink tools
