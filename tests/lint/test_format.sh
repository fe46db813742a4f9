#!/usr/bin/env bash
# Every C and C++ file is formatted as .clang-format says, and none is longer than one subject needs.
set -euo pipefail
cd "$TSR_SOURCE"
command -v clang-format >/dev/null || { echo "tarsier skipped: test_format: clang-format is not installed"; exit 77; }
mapfile -t files < <(find firmware hal emulator sink tools tests -name '*.[ch]' -o -name '*.cpp' | sort)
clang-format --dry-run --Werror "${files[@]}"
long=$(wc -l "${files[@]}" | awk '$2 != "total" && $1 > 450 {print $2 ": " $1 " lines"}')
[ -z "$long" ] || { echo "$long"; exit 1; }
echo "${#files[@]} files"
