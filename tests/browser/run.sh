#!/bin/sh
# Opens pages in headless Chromium and checks that they work:
#   tests/browser/run.sh REPORT.html...
#   tests/browser/run.sh view GRAINFLOW LOG [LOG2]
# Installs what it needs on Debian; fails when a tool is missing.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
[ "$#" -gt 0 ] || { echo "usage: $0 REPORT.html... | view GRAINFLOW LOG [LOG2]" >&2; exit 2; }

missing=""
command -v chromium >/dev/null 2>&1 || missing="$missing chromium"
command -v chromedriver >/dev/null 2>&1 || missing="$missing chromium-driver"
command -v python3 >/dev/null 2>&1 || missing="$missing python3"
if [ -n "$missing" ]; then
    command -v apt-get >/dev/null 2>&1 || { echo "missing:$missing, and no apt-get to install it" >&2; exit 1; }
    become=""
    [ "$(id -u)" = 0 ] || become="sudo"
    $become apt-get update -qq
    # shellcheck disable=SC2086 # a list of packages
    DEBIAN_FRONTEND=noninteractive $become apt-get install -y -qq --no-install-recommends $missing fonts-dejavu-core >/dev/null
fi
for tool in chromium chromedriver python3; do
    command -v "$tool" >/dev/null 2>&1 || { echo "$tool is missing" >&2; exit 1; }
done
if [ "$1" = view ]; then
    shift
    exec python3 "$here/view.py" "$@"
fi
exec python3 "$here/report.py" "$@"
