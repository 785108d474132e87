#!/usr/bin/env bash
# Counts the instructions of small fixed cases under valgrind and compares them with those kept beside this script:
#   benches/instructions.sh            fails where a case differs by more than 3 %
#   benches/instructions.sh --renew    keeps what is counted now
# Counts do not depend on how busy a machine is; they do on the compiler, and a little on the processor's kind
# (memory is copied by what it has). Installs valgrind on Debian where it is missing; fails when it cannot.
set -euo pipefail
cd "$(dirname "$0")/.."
[ "$#" -eq 0 ] || [ "$*" = --renew ] || { echo "usage: $0 [--renew]" >&2; exit 2; }
kept=benches/instructions.csv
steps=10

if ! command -v valgrind > /dev/null 2>&1; then
    command -v apt-get > /dev/null 2>&1 || { echo "valgrind is missing, and no apt-get to install it" >&2; exit 1; }
    become=""
    [ "$(id -u)" = 0 ] || become="sudo"
    $become apt-get update -qq
    DEBIAN_FRONTEND=noninteractive $become apt-get install -y -qq --no-install-recommends valgrind > /dev/null
    command -v valgrind > /dev/null 2>&1 || { echo "valgrind is missing" >&2; exit 1; }
fi

# Instructions of the plain processor, whatever a user's own flags say.
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS
message=$(cargo bench --bench instructions --no-run --message-format=json-render-diagnostics |
    grep '"name":"instructions"' | grep '"executable":"')
program=$(sed 's/.*"executable":"\([^"]*\)".*/\1/' <<< "$message")

log=$(mktemp)
now=$(mktemp)
trap 'rm -f "$log" "$now"' EXIT

# Instructions of `program $1 $2`, from the building of its gas to its end; its grains are left in `grains`.
count() {
    grains=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null --log-file="$log" "$program" "$1" "$2") ||
        { cat "$log" >&2; exit 1; }
    counted=$(sed -n 's/.*Collected : *\([0-9]*\).*/\1/p' "$log")
}

echo "# Instructions per grain and step (event-driven: per grain and tenth of a collision per particle)" > "$now"
echo "# $(rustc --version)" >> "$now"
for name in $("$program" --list); do
    count "$name" 0
    before=$counted
    count "$name" "$steps"
    awk -v name="$name" -v all=$((counted - before)) -v parts=$((grains * steps)) \
        'BEGIN { printf "%s,%.2f\n", name, all / parts }' >> "$now"
done

if [ "$*" = --renew ]; then
    cp "$now" "$kept"
    cat "$kept"
    exit
fi
[ -f "$kept" ] || { echo "$kept is missing; $0 --renew makes it" >&2; exit 1; }
awk -F, -v file="$kept" '
    /^#/ { if (FNR == 2) compiler[NR == FNR] = $0; next }
    NF < 2 { next }
    NR == FNR { kept[$1] = $2; next }
    FNR <= 3 { printf "%-16s %10s %10s %8s\n", "case", "kept", "now", "change" }
    {
        seen[$1] = 1
        if (!($1 in kept)) { printf "%-16s %10s %10.2f %8s  not kept\n", $1, "", $2, ""; bad = 1; next }
        change = 100 * ($2 / kept[$1] - 1)
        verdict = change > 3 ? "more" : change < -3 ? "fewer" : ""
        if (verdict != "") bad = 1
        printf "%-16s %10.2f %10.2f %+7.1f%%  %s\n", $1, kept[$1], $2, change, verdict
    }
    END {
        for (name in kept) if (!(name in seen)) { printf "%-16s is kept, but no case any more\n", name; bad = 1 }
        if (compiler[1] != compiler[0]) print "kept with" substr(compiler[1], 2) ", now" substr(compiler[0], 2)
        if (!bad) exit
        print "Instructions per grain and step have changed by more than 3 %. More of them: find out why."
        print "Fewer, or more for a good reason: benches/instructions.sh --renew, and keep " file "."
        exit 1
    }' "$kept" "$now"
