# SPDX-License-Identifier: Apache-2.0
# A cluster of three nodes on this machine, from Debian's slurmctld and slurmd: in a folder, on ports of its own,
# without munge, systemd or root. For scripts to source.

# Why Slurm cannot run here; nothing where it can.
cluster_missing() {
  local program
  for program in slurmctld slurmd sbatch squeue scontrol scancel; do
    PATH=$PATH:/usr/sbin command -v "$program" >/dev/null || { printf 'there is no %s\n' "$program" && return; }
  done
}

# cluster_start FOLDER: writes slurm.conf, exports SLURM_CONF and starts a controller and three nodes of one core.
cluster_start() {
  cluster=$(cd "$1" && pwd)
  PATH=$PATH:/usr/sbin
  export SLURM_CONF=$cluster/slurm.conf
  mkdir -p "$cluster"/{state,log,spool/node0,spool/node1,spool/node2}
  local port=$((20000 + RANDOM % 12000))
  while cluster_taken "$port" || cluster_taken $((port + 2)); do port=$((port + 10)); done
  cluster_configuration "$port" >"$SLURM_CONF"
  controller_start && nodes_start && cluster_wait 'three idle nodes' cluster_is_idle
}

cluster_taken() {
  (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null
}

# MaxArraySize 5: indices 0 to 4, so that a plan of more tasks is split. cred_expire is how long a task waits that was
# queued again: two minutes unless it is said.
cluster_configuration() {
  local host user node
  host=$(uname -n) user=$(id -un)
  host=${host%%.*}
  cat <<END
ClusterName=weft
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$1
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/none
AuthInfo=cred_expire=5
CredType=cred/none
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool/%n
SlurmctldPidFile=$cluster/controller.pid
SlurmdPidFile=$cluster/%n.pid
SlurmctldLogFile=$cluster/log/controller.txt
SlurmdLogFile=$cluster/log/%n.txt
SwitchType=switch/none
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$cluster/log/jobs.txt
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1,bf_interval=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
DefMemPerCPU=500
ReturnToService=2
SlurmctldTimeout=30
SlurmdTimeout=30
KillWait=5
BatchStartTimeout=1
MessageTimeout=10
MaxArraySize=${CLUSTER_ARRAY_SIZE:-5}
MailProg=/bin/true
END
  for node in 0 1 2; do
    printf 'NodeName=node%d NodeHostname=%s NodeAddr=127.0.0.1 Port=%d CPUs=1 RealMemory=6000 State=UNKNOWN\n' \
      "$node" "$host" $(($1 + 1 + node))
  done
  printf 'PartitionName=night Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n'
}

parent_of() {
  sed -n 's/^PPid:[[:space:]]*//p' "/proc/$1/status" 2>/dev/null
}

# The controller is gone at once, and comes back.
controller_dies() {
  kill -KILL "$controller_pid"
  wait "$controller_pid" 2>/dev/null
}

controller_start() {
  slurmctld -D >>"$cluster/log/controller.out" 2>&1 &
  controller_pid=$!
}

# A controller that was killed believes for minutes that tasks run which ended in its last seconds. A slurmd that begins
# anew tells what it runs, and then they are queued again; what runs goes on. Not before BatchStartTimeout and
# MessageTimeout have passed since the controller came back.
nodes_begin_anew() {
  local node
  kill "${node_pids[@]}"
  wait "${node_pids[@]}" 2>/dev/null
  for node in 0 1 2; do node_start "$node"; done
}

nodes_start() {
  local node
  node_pids=()
  for node in 0 1 2; do node_start "$node"; done
}

node_start() {
  slurmd -D -N "node$1" >>"$cluster/log/node$1.out" 2>&1 &
  node_pids[$1]=$!
}

# node_dies N PID: the machine is gone, with everything that ran on it: its slurmd, the process PID of a task and the
# step that started that. Slurm would believe for minutes that they run, so it is told.
node_dies() {
  local step
  # The step first: it would report the end of its task to the controller.
  step=$(parent_of "$2") && kill -KILL "$step" "${node_pids[$1]}" "$2" || return
  wait "${node_pids[$1]}" 2>/dev/null
  scontrol update nodename="node$1" state=down reason='it is gone'
}

node_returns() {
  node_start "$1"
  sleep 1
  scontrol update nodename="node$1" state=resume 2>/dev/null
  return 0
}

cluster_is_idle() {
  [[ $(sinfo -h -o '%D %t' 2>/dev/null) == '3 idle' ]]
}

cluster_is_empty() {
  local queued
  queued=$(squeue -h 2>/dev/null) && [[ -z $queued ]]
}

# cluster_wait WHAT COMMAND...: until COMMAND holds; fails after ${CLUSTER_PATIENCE} s.
cluster_wait() {
  local what=$1 until=$((SECONDS + ${CLUSTER_PATIENCE:-60}))
  shift
  until "$@"; do
    if ((SECONDS > until)); then
      printf 'waited in vain for %s\n' "$what" >&2
      squeue -r -o '%i %T %r %N' >&2
      return 1
    fi
    sleep 0.1
  done
}

# Ends all that cluster_start and its jobs started.
cluster_stop() {
  [[ -n ${cluster:-} ]] || return 0
  scancel --user "$(id -un)" 2>/dev/null
  CLUSTER_PATIENCE=10 cluster_wait 'an empty queue' cluster_is_empty
  kill "${node_pids[@]}" "$controller_pid" 2>/dev/null
  wait "${node_pids[@]}" "$controller_pid" 2>/dev/null
  cluster=
}
