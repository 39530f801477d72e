#!/usr/bin/env bash
# Every source is formatted by the .clang-format of the tree.
set -euo pipefail
cd "$(dirname "$0")/../.."
find src tests verification regression -name '*.hpp' -o -name '*.cpp' | sort | xargs clang-format --dry-run -Werror
echo "every source is formatted"
