#!/usr/bin/env bash
# One regression as N jobs of GNU parallel on this machine, or on several: add --sshloginfile and a shared folder.
#   docs/campaigns/parallel.sh 8 target/campaign slam --seeds 100
set -euo pipefail
n=${1:?usage: parallel.sh N OUT [SUITE…] [options of wayfix-experiments regress]}
out=${2:?usage: parallel.sh N OUT [SUITE…] [options of wayfix-experiments regress]}
shift 2
mkdir -p "$out"
seq "$n" | parallel --halt soon,fail=1 --joblog "$out/jobs.log" \
  "${WAYFIX:-wayfix-experiments}" regress "$@" --threads 1 --shard "{}/$n" --out "$out/share-{}"
"${WAYFIX:-wayfix-experiments}" merge-reports --out "$out" "$out"/share-*
