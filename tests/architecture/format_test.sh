#!/usr/bin/env bash
# Every source is formatted by the .clang-format of the tree.
set -euo pipefail
cd "$(dirname "$0")/../.."
# Other versions format some lines in another way.
if ! clang-format --version | grep -q ' version 14\.'; then
  echo "skipped: needs clang-format 14, as in Debian 12"
  exit 77
fi
find src tests verification regression -name '*.hpp' -o -name '*.cpp' | sort | xargs clang-format --dry-run -Werror
echo "every source is formatted"
