#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check.sh BUILD: batches on a real Slurm of three nodes that run on this machine. A plan is submitted, found again,
# a node goes down, a task is stopped and queued again, the controller is killed and started again, a disk fills. Each
# session must end with one published solve of the bytes that this machine makes alone, none half made. Says so and
# ends well where there is no Slurm. WEFT_KEEP=1 leaves its folder in the system's temporary one.
set -uo pipefail
build=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/cluster.sh"

missing=$(cluster_missing)
if [[ -n $missing ]]; then
  printf 'SKIPPED: %s; install slurmctld, slurmd and slurm-client\n' "$missing" >&2
  exit 0
fi

work=$(mktemp -d)
weft=$build/bin/weft
failures=0
sessions=24
trap 'cluster_stop; [[ -n ${WEFT_KEEP:-} ]] || rm -rf "$work"' EXIT

step() {
  printf '%4d s  %s\n' "$SECONDS" "$*" >&2
}

# holds SENTENCE COMMAND...: a check.
holds() {
  local sentence=$1
  shift
  "$@" && return 0
  printf '  FAILED: %s\n' "$sentence" >&2
  failures=$((failures + 1))
}

give_up() {
  printf 'FAILED: %s\n' "$*" >&2
  tail -n 20 "$work"/log/* "$work"/*.results/log/* "$work"/cluster/log/controller.txt 2>/dev/null >&2
  exit 1
}

run() {
  mkdir -p "$work/log"
  "$@" >"$work/log/last.txt" 2>&1 || give_up "$* ended with $?: $(cat "$work/log/last.txt")"
}

# Two cloths with a solve and links to them, and what this machine alone makes of the two.
make_archive() {
  local i
  for i in 0 1; do
    sed -e "s/^seed.*/seed = $((i + 1))/; s/^width.*/width = 640/; s/^height.*/height = 480/" \
      "$here/../../testdata/scenes/golden.toml" >"$work/scene.toml"
    run "$weft" simulate "$work/scene.toml" -o "$work/cloth-$i.weft" -q
    rm -rf "$work/cloth-$i.weft/truth"
    run "$weft" solve "$work/cloth-$i.weft" --quality fast -q
  done
  mkdir "$work/archive"
  for ((i = 0; i < sessions; ++i)); do cp -al "$work/cloth-$((i % 2)).weft" "$work/archive/cloth-$i.weft"; done
  for i in 0 1; do run "$weft" solve "$work/cloth-$i.weft" --quality standard -q; done
}

# plan NAME QUALITY SESSION...: a task a session.
plan() {
  run "$weft" batch plan "${@:3}" --quality "$2" --sample 1 --task-minutes 0.001 -q -o "$work/$1.jsonl"
}

id_of() {
  sed -n '1s/.*"id":"\([0-9a-f]*\)".*/\1/p' "$work/$1.jsonl"
}

# Reasons of what waits for a person: held, or what a node could not start while the controller was gone.
held_words='JobHeld[A-Za-z]*|launch failed requeued held'

# queued NAME FORMAT [STATE]: of a plan, a task a line.
queued() {
  squeue -h -r -n "weft-$(id_of "$1")" -o "$2" ${3:+-t "$3"}
}

is_through() {
  local id queue
  id=$(id_of "$1")
  queue=$(squeue -h -n "weft-$id,weft-$id-merge" 2>/dev/null) && [[ -z $queue ]]
}

# A task of the plan `night` in the midst of its session: job, node and process, and the fork of it that solves, which
# is stopped where it is, so that it does not end before something befalls it.
find_running() {
  local pid variables
  for pid in $(pgrep -f "^[^ ]*weft-work batch run $work/night.jsonl --array-from"); do
    variables=$(tr '\0' '\n' <"/proc/$pid/environ" 2>/dev/null) || continue
    # Of the two that look alike the one that Slurm started: the other is its fork.
    [[ $(ps -o comm= -p "$(parent_of "$pid")") == slurmstepd ]] || continue
    running_job=$(sed -n 's/^SLURM_JOB_ID=//p' <<<"$variables")
    running_node=$(sed -n 's/^SLURMD_NODENAME=node//p' <<<"$variables")
    running_pid=$pid
    running_fork=$(pgrep -P "$pid") && kill -STOP "$running_fork" || continue
    is_stopped "$running_fork" && return 0
    kill -CONT "$running_fork" 2>/dev/null
  done
  return 1
}

is_stopped() {
  sleep 0.02
  [[ $(ps -o stat= -p "$1") == T* ]]
}

is_asked_to_end() {
  local pending
  pending=$(sed -n 's/^ShdPnd:[[:space:]]*//p' "/proc/$1/status" 2>/dev/null)
  ((0x${pending:-0} >> 14 & 1))
}

has_restarted() {
  scontrol show job "$1" -o 2>/dev/null | grep -q "^JobId=$1 .* Restarts=[1-9]"
}

has_met_full_disk() {
  grep -qs 'No space left' "$work"/night.results/log/*.txt
}

# Something is missing, and nothing has failed.
is_to_be_tried_again() {
  local said
  said=$("$weft" batch status "$work/night.jsonl" --json -q 2>/dev/null | tr -d ' \n')
  [[ $said =~ \"missing\":[1-9] && $said =~ \"failed\":0 ]]
}

# Of the report of a plan.
count_of() {
  # The first of that name: each session has its own share that is solved, too.
  tr -d ' \n' <"$work/$1.results/report/report.json" | grep -o "\"$2\":[0-9]*" | head -n 1 | sed 's/.*://'
}

# One published solve beside the one before, and the bytes of this machine.
is_solved_once() {
  local solves documents
  solves=("$1"/solve/*) documents=("$1"/solve/*/solve.json)
  ((${#solves[@]} == 2 && ${#documents[@]} == 2))
}

same_bytes() {
  local file
  for file in "$2"/solve/*/{*.exr,status.png}; do
    cmp "$file" "$1${file#"$2"}" || return 1
  done
  for file in "$2"/solve/*/solve.json; do
    diff <(timeless "$file") <(timeless "$1${file#"$2"}") || return 1
  done
}

# A solve.json without its seconds, foretold and taken, and the plan that asked for it.
timeless() {
  sed -e '/^  "foretold": {$/,/^  }/d; /^  "taken": {$/,/^  }/d; /^  "plan": /d' "$1"
}

# What is queued waits for release(), however quick this machine is. A controller writes its queue down every five
# seconds; one that dies before would know neither what was held nor, in the end, what was submitted.
hold() {
  run scontrol hold "jobname=weft-$(id_of night)"
  sleep 0.5
  touch "$work/held"
  cluster_wait 'the queue to be written down' is_written_down || give_up 'the queue is not written down'
}

is_written_down() {
  [[ $cluster/state/job_state -nt $work/held ]]
}

# release COUNT: so many of the arrays that are held. Where tasks of one have ended, scontrol calls that a failure.
release() {
  local array
  for array in $(queued night '%F %r' PD | sed -nE "s/ ($held_words)\$//p" | sort -nu | head -n "$1"); do
    scontrol release "$array" >"$work/log/released.txt" 2>&1
  done
}

submit_twice() {
  run scontrol update partitionname=night state=down
  run "$weft" batch submit "$work/night.jsonl" --json
  cp "$work/log/last.txt" "$work/log/submitted.txt"
  hold
  run scontrol update partitionname=night state=up
  holds '24 tasks are five arrays where indices end at 4' \
    test "$(grep -o '"--job-name=weft-[0-9a-f]*"' "$work/log/submitted.txt" | wc -l)" = 5
  run "$weft" batch submit "$work/night.jsonl"
  holds 'a second submit finds the first' grep -q 'are queued already' "$work/log/last.txt"
  holds 'and submits nothing' test "$(queued night %F | sort -u | wc -l)" = 5
}

lose_a_node() {
  release 1
  cluster_wait 'a running task' find_running || give_up 'no task runs'
  local job=$running_job node=$running_node
  node_dies "$node" "$running_pid" || give_up "node$node does not die"
  cluster_wait "job $job to be queued again" has_restarted "$job" || give_up 'a lost task is not queued again'
  step "node$node died, job $job is queued again"
  node_returns "$node"
}

stop_a_task() {
  release 1
  cluster_wait 'a running task' find_running || give_up 'no task runs'
  local job=$running_job
  scancel --signal=TERM --batch "$job"
  cluster_wait "the fork of job $job to be asked to end" is_asked_to_end "$running_fork" || give_up 'a task is not stopped'
  kill -CONT "$running_fork"
  cluster_wait "job $job to be queued again" has_restarted "$job" || give_up 'a stopped task is not queued again'
  step "job $job was stopped and queued itself again"
}

results() {
  cat "$work"/night.results/task-*.jsonl 2>/dev/null | wc -l
}

has_results_beyond() {
  (($(results) > $1))
}

# As a task ends, so that the controller forgets that it did.
lose_the_controller() {
  local before
  before=$(results)
  release 1
  cluster_wait 'a task that ends' has_results_beyond "$before" || give_up 'no task ends'
  sleep 0.3
  controller_dies
  step 'the controller died'
  sleep 1
  controller_start
  controller_back=$SECONDS
  cluster_wait 'a controller' squeue -h >/dev/null || give_up 'the controller does not come back'
  run "$weft" batch submit "$work/night.jsonl"
  holds 'the queue is as it was' grep -q 'are queued already' "$work/log/last.txt"
}

has_none_running() {
  local reasons
  reasons=$(queued night %r) && [[ -n $reasons ]] && ! grep -qvE "^($held_words)$" <<<"$reasons"
}

# No task runs when it fills, so that those which meet it have solved nothing yet.
fill_the_disk() {
  cluster_wait 'what was released' has_none_running || give_up 'what was released does not end'
  touch "$work/full"
  release 1
  cluster_wait 'a task that meets a full disk' has_met_full_disk || give_up 'no task met the full disk'
  rm "$work/full"
  step 'the disk was full'
}

night() {
  plan night standard "$work/archive"
  # Every task has a disk that can be filled.
  export LD_PRELOAD=$build/virtual_rig/disk/libweft_disk_shim.so WEFT_FULL_DISK=$work/full
  submit_twice
  unset LD_PRELOAD
  step 'submitted'
  lose_a_node
  stop_a_task
  lose_the_controller
  sleep $((controller_back + 13 > SECONDS ? controller_back + 13 - SECONDS : 0))
  nodes_begin_anew
  fill_the_disk
  release "$sessions"
  CLUSTER_PATIENCE=180 cluster_wait 'the end of the batch' is_through night || give_up 'the batch does not end'
  holds 'what met a full disk is missing and not failed' is_to_be_tried_again
  run "$weft" batch submit "$work/night.jsonl"
  CLUSTER_PATIENCE=120 cluster_wait 'the end of the batch' is_through night || give_up 'the batch does not end'
  step 'the batch is through'
}

look_at_night() {
  local i
  holds 'the report came by itself' test -f "$work/night.results/report/report.json"
  holds 'every session is solved' test "$(($(count_of night solved) + $(count_of night there)))" = "$sessions"
  holds 'none is missing' test "$(count_of night missing)" = 0
  holds 'none has failed' test "$(count_of night failed)" = 0
  holds 'every solve is held against the one before' \
    test "$(tr -d ' \n' <"$work/night.results/report/report.json" | grep -o '"change":{' | wc -l)" -ge "$(count_of night solved)"
  for ((i = 0; i < sessions; ++i)); do
    holds "session $i has one published solve" is_solved_once "$work/archive/cloth-$i.weft"
    holds "session $i has the bytes of this machine" same_bytes "$work/archive/cloth-$i.weft" "$work/cloth-$((i % 2)).weft"
  done
  holds 'nothing is half made' test -z "$(find "$work/archive" -name '*.partial*')"
  step "$(cat "$work"/night.results/task-*.jsonl | grep -c '"state":"solved"') solves of $sessions sessions, \
$(count_of night second_attempts) begun more than once, $(count_of night abandoned) half-made folders removed"
}

# What is cancelled stays cancelled, and a run on this machine goes on with it.
cancel_another() {
  plan quick robust "$work"/archive/cloth-{0,1,2,3}.weft
  run "$weft" batch submit "$work/quick.jsonl" --at-once 1
  cluster_wait 'a running task' eval '[[ -n $(queued quick %i R) ]]' || give_up 'no task runs'
  run "$weft" batch cancel "$work/quick.jsonl"
  cluster_wait 'an empty queue' is_through quick || give_up 'what is cancelled goes on'
  holds 'a cancelled task is not queued again' eval '! grep -q "^queued again" "$work"/quick.results/log/*.txt'
  run "$weft" batch run "$work/quick.jsonl" -q
  run "$weft" batch merge "$work/quick.jsonl" -q
  holds 'this machine ends what the cluster began' test "$(count_of quick missing)" = 0
  step 'cancelled, and ended on this machine'
}

step 'a cluster of three nodes'
mkdir "$work/cluster"
cluster_start "$work/cluster" || give_up 'Slurm does not start'
make_archive
step "an archive of $sessions sessions"
night
look_at_night
cancel_another
((failures == 0)) || give_up "$failures checks failed"
step 'every session has one solve'
