#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# many.sh BUILD [TASKS]: so many small tasks (200) on a Slurm of three nodes on this machine, of which one dies after a
# third of them. Prints how long it took, and what a simulation needs to know (docs/archives.md): how long the first thirty
# tasks took by Slurm's own clock, and how long a node was theirs for each, with what Slurm takes to start the next.
set -uo pipefail
build=$(cd "$1" && pwd)
tasks=${2:-200}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/cluster.sh"
missing=$(cluster_missing)
[[ -z $missing ]] || { printf 'SKIPPED: %s\n' "$missing" >&2 && exit 0; }
work=$(mktemp -d)
weft=$build/bin/weft
trap 'cluster_stop; rm -rf "$work"' EXIT

solves() {
  find "$work"/archive -name solve.json | wc -l
}

is_busy() {
  [[ -n $(squeue -h -w node2 -t R 2>/dev/null) ]]
}

has_solves() {
  (($(solves) >= $1))
}

is_through() {
  local queue
  queue=$(squeue -h 2>/dev/null) && [[ -z $queue ]]
}

mkdir -p "$work"/{cluster,archive}
CLUSTER_ARRAY_SIZE=1001 cluster_start "$work/cluster" || exit 1
sed -e 's/^width.*/width = 160/; s/^height.*/height = 128/' "$here/../../testdata/scenes/golden.toml" >"$work/scene.toml"
"$weft" simulate "$work/scene.toml" -o "$work/cloth.weft" -q || exit 1
rm -rf "$work/cloth.weft/truth"
for ((i = 0; i < tasks; ++i)); do cp -al "$work/cloth.weft" "$work/archive/cloth-$i.weft"; done
"$weft" batch plan "$work/archive" --sample 1 --task-minutes 0.001 -q -o "$work/night.jsonl" >/dev/null || exit 1
began=$(date +%s.%N)
"$weft" batch submit "$work/night.jsonl" >&2 || exit 1
export CLUSTER_PATIENCE=1800
cluster_wait 'a third of them' has_solves $((tasks / 3)) || exit 1
cluster_wait 'a task on node2' is_busy || exit 1
scontrol update nodename=node2 state=down reason='it is gone'
sleep 10
scontrol update nodename=node2 state=resume
cluster_wait 'the end' has_solves "$tasks" || exit 1
ended=$(date +%s.%N)
cluster_wait 'the report' is_through || exit 1
awk -v tasks="$tasks" -v seconds="$(awk "BEGIN { print $ended - $began }")" -v solves="$(solves)" '
  function second(key,   clock) {
    match($0, key "=[^ ]*T[0-9:]*")
    split(substr($0, RSTART, RLENGTH), clock, "T")
    split(clock[length(clock)], clock, ":")
    return clock[1] * 3600 + clock[2] * 60 + clock[3]
  }
  /JobState=COMPLETED/ && n < 30 {
    begin = second("StartTime"); end = second("EndTime")
    sum += end - begin
    if (!n || begin < first) first = begin
    if (end > last) last = end
    ++n
  }
  /JobState=NODE_FAIL/ { ++lost }
  END {
    printf "%d tasks in %.1f s, %d solves, %d tasks lost; of the first %d: %.2f s each, a node for %.2f s\n",
      tasks, seconds, solves, lost, n, sum / n, 3 * (last - first) / n
  }' "$cluster/log/jobs.txt"
