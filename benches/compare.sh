#!/usr/bin/env bash
# Compares two commits on this machine, in one run: the bench `steps` of both is built and run in turn.
#   benches/compare.sh BASE [OTHER] [-- words of steps]
#   benches/compare.sh main
#   benches/compare.sh v0.1 HEAD -- hsmc 2d gas heap 100000 1
# OTHER is the working tree as it is, unless a commit is named. ROUNDS=5 says how often each is run; every run times each
# row three times and says the median. A commit without the bench gets the benches of this working tree.
# Everything stays in target/compare: worktrees, builds (used again next time), and what was measured.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
usage() { sed -n '2,5s/^# *//p' "$0" >&2; exit 2; }
case "${1:-}" in "" | -*) usage ;; esac
base=$1
shift
other=""
if [ "$#" -gt 0 ] && [ "$1" != -- ]; then
    other=$1
    shift
fi
[ "$#" -eq 0 ] || [ "$1" = -- ] || usage
[ "$#" -eq 0 ] || shift
rounds=${ROUNDS:-5}
place=$root/target/compare
mkdir -p "$place"

# Checks a commit out into the worktree of a side, and gives it benches where it has none.
check_out() {
    local side=$1 commit tree=$place/$1
    commit=$(git rev-parse --verify --quiet "$2^{commit}") || { echo "there is no commit $2" >&2; exit 1; }
    if [ -e "$tree/.git" ]; then
        git -C "$tree" reset --quiet --hard
        git -C "$tree" clean --quiet -fdx
        git -C "$tree" checkout --quiet --detach "$commit"
    else
        git worktree add --quiet --force --detach "$tree" "$commit"
    fi
    [ ! -f "$tree/benches/steps.rs" ] || return 0
    echo "$side ($2) has no bench \`steps\`: it gets the benches of the working tree"
    rm -rf "$tree/benches"
    cp -r "$root/benches" "$tree/benches"
    # Of the manifest, the list of benches alone.
    awk '/^\[\[bench\]\]/ { skip = 1; next } /^\[/ { skip = 0 } !skip' "$tree/Cargo.toml" > "$tree/Cargo.new"
    awk '/^\[\[bench\]\]/ { keep = 1 } /^\[/ && !/^\[\[bench\]\]/ { keep = 0 } keep' "$root/Cargo.toml" >> "$tree/Cargo.new"
    mv "$tree/Cargo.new" "$tree/Cargo.toml"
}

# Builds the bench in a tree; the program becomes target/compare/SIDE-steps. Each tree has a folder of its own to build in:
# in one folder cargo would take the one tree's unchanged files for those of the other.
build() {
    local side=$1 tree=$2 folder=$3 message
    echo "building $side" >&2
    message=$(cd "$tree" && CARGO_TARGET_DIR=$folder cargo bench --bench steps --no-run --message-format=json-render-diagnostics) ||
        { echo "$side does not build with these benches: $tree" >&2; exit 1; }
    message=$(grep '"name":"steps"' <<< "$message" | sed -n 's/.*"executable":"\([^"]*\)".*/\1/p')
    cp "$message" "$place/$side-steps"
}

check_out base "$base"
build base "$place/base" "$place/base-build"
if [ -n "$other" ]; then
    check_out other "$other"
    build other "$place/other" "$place/other-build"
else
    build other "$root" "$root/target"
fi

rm -f "$place"/base.csv "$place"/other.csv
echo "base: $base; other: ${other:-working tree}; $rounds pairs of runs"
for round in $(seq "$rounds"); do
    # Who runs first changes, so that a drift of the machine hits both.
    sides="base other"
    [ $((round % 2)) = 1 ] || sides="other base"
    for side in $sides; do
        "$place/$side-steps" --rounds=3 "$@" --csv > "$place/run.csv"
        sed "s/^/$round,/" "$place/run.csv" >> "$place/$side.csv"
    done
done

awk -F, '
    function median(list, n,   i, j, t) {
        for (i = 2; i <= n; i++) for (j = i; j > 1 && list[j - 1] > list[j]; j--) {
            t = list[j]; list[j] = list[j - 1]; list[j - 1] = t
        }
        return n % 2 ? list[(n + 1) / 2] : (list[n / 2] + list[n / 2 + 1]) / 2
    }
    $2 == "dimension" {
        if ($8 != "rate") { print "these benches write other tables" > "/dev/stderr"; failed = 1; exit 1 }
        next
    }
    { row = $2 "D " $3 " " $4 " " $5 ", threads " $6 }
    NR == FNR { base[row, $1] = $8; next }
    {
        if (!(row in known)) { known[row] = 1; rows[++number] = row }
        other[row, $1] = $8
        if ($1 > rounds) rounds = $1
    }
    END {
        if (failed) exit 1
        printf "%-40s %10s %10s %8s %18s\n", "million particle-steps per second", "base", "other", "ratio", "ratios of pairs"
        for (k = 1; k <= number; k++) {
            row = rows[k]; n = 0
            for (r = 1; r <= rounds; r++) {
                if (!((row, r) in base) || !((row, r) in other)) continue
                n++
                a[n] = base[row, r] + 0; b[n] = other[row, r] + 0; c[n] = b[n] / a[n]
            }
            if (!n) { printf "%-40s in one of them alone\n", row; continue }
            middle = median(c, n)
            printf "%-40s %10.2f %10.2f %8.3f %9.3f … %.3f\n", row, median(a, n), median(b, n), middle, c[1], c[n]
        }
    }' "$place/base.csv" "$place/other.csv"
