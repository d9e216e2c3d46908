# shellcheck shell=bash
# A Slurm cluster of one node, for tests: `start_slurm FOLDER` starts it as root with all of its
# files in a folder, and `stop_slurm` ends it. It needs these packages of Debian or Ubuntu:
# slurmctld, slurmd, slurm-client, munge.

slurm_processes=()

start_slurm() {
  local folder=$1 host
  host=$(hostname -s)
  mkdir -p "$folder"/{state,spool,log}
  # The daemon of munge refuses folders that others can write to.
  chmod 755 "$folder"
  head -c 1024 /dev/urandom > "$folder/munge.key"
  chmod 400 "$folder/munge.key"
  cat > "$folder/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
# A job that is queued again waits for as long as its credentials are valid.
AuthInfo=socket=$folder/munge.socket,cred_expire=5
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld
SlurmdLogFile=$folder/log/slurmd
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
KillWait=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES State=UP
CONF
  echo "CgroupPlugin=cgroup/v1" > "$folder/cgroup.conf"
  export SLURM_CONF=$folder/slurm.conf
  munged --foreground --force --socket "$folder/munge.socket" --key-file "$folder/munge.key" \
    --pid-file "$folder/munge.pid" --log-file "$folder/log/munge" \
    --seed-file "$folder/munge.seed" 2> "$folder/log/munge.stderr" &
  slurm_processes+=($!)
  wait_for 20 test -S "$folder/munge.socket"
  slurmctld -D -f "$SLURM_CONF" 2>> "$folder/log/slurmctld" &
  slurm_processes+=($!)
  slurmd -D -f "$SLURM_CONF" 2>> "$folder/log/slurmd" &
  slurm_processes+=($!)
  wait_for 20 node_is_idle || {
    tail -n 12 "$folder"/log/* >&2
    return 1
  }
}

node_is_idle() {
  [[ $(sinfo --noheader --format %T 2> /dev/null) == idle ]]
}

stop_slurm() {
  local process
  for process in "${slurm_processes[@]}"; do
    kill "$process" 2> /dev/null || true
  done
  wait
}

# wait_for SECONDS COMMAND...: waits until a command succeeds.
wait_for() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    if ((SECONDS >= end)); then
      echo "still waiting for: $*" >&2
      return 1
    fi
    sleep 0.1
  done
}
