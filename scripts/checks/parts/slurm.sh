# Sourced by scripts/check farms: a Slurm on this machine, with its own munge, ports and state, beside whatever runs here.
# Debian's slurmd is built with --enable-multiple-slurmd, so two of them share the host as n1 and n2.

# start_slurm FOLDER
start_slurm() {
    slurm=$1
    rm -rf "$slurm"
    mkdir -p "$slurm"/{state,log,n1,n2}
    chmod 711 "$slurm"
    dd if=/dev/urandom of="$slurm/munge.key" bs=1024 count=1 status=none
    chmod 400 "$slurm/munge.key"
    local port=$((20000 + $$ % 10000 * 4)) host
    host=$(hostname -s)
    cat >"$slurm/slurm.conf" <<END
ClusterName=check
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$slurm/munge.socket
StateSaveLocation=$slurm/state
SlurmdSpoolDir=$slurm/%n
SlurmctldPidFile=$slurm/controller.pid
SlurmdPidFile=$slurm/%n.pid
SlurmctldLogFile=$slurm/log/controller
SlurmdLogFile=$slurm/log/%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SlurmdParameters=config_overrides
SlurmdTimeout=10
ReturnToService=2
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES State=UP
END
    export SLURM_CONF=$slurm/slurm.conf
    munged --force --socket="$slurm/munge.socket" --key-file="$slurm/munge.key" --pid-file="$slurm/munge.pid" \
        --log-file="$slurm/log/munge" --seed-file="$slurm/munge.seed"
    slurmctld
    start_node n1
    start_node n2
    local waited
    for waited in $(seq 60); do
        [ "$(sinfo -h -N -o %T 2>/dev/null | grep -c idle)" -ne 2 ] || return 0
        sleep 1
    done
    echo "Slurm did not start: $(tail -n 3 "$slurm"/log/*)" >&2
    return 1
}

# start_node NAME: a node daemon in a namespace of processes that ends with it, so that its jobs die with it as with a machine.
# Its process number goes to NAME.outside.
start_node() {
    unshare --pid --fork --mount-proc --kill-child slurmd -D -N "$1" >"$slurm/log/$1.out" 2>&1 &
    echo $! >"$slurm/$1.outside"
    disown
}

stop_slurm() {
    local file
    # unshare passes over SIGTERM while its child lives.
    for file in "$slurm"/n1.outside "$slurm"/n2.outside; do
        [ ! -e "$file" ] || kill -9 "$(cat "$file")" 2>/dev/null || true
        rm -f "$file"
    done
    for file in "$slurm"/controller.pid "$slurm"/munge.pid; do
        [ ! -e "$file" ] || kill "$(cat "$file")" 2>/dev/null || true
    done
}

# wait_for_slurm: until no job is left.
wait_for_slurm() {
    local waited
    for waited in $(seq 600); do
        [ -n "$(squeue -h)" ] || return 0
        sleep 1
    done
    squeue >&2
    return 1
}

# run_on_slurm JOB
run_on_slurm() {
    sh "$1/submit.sh" >>slurm.log
    wait_for_slurm
}

# kill_node_in_the_middle_of JOB: leaves how often each task was started again in JOB.restarts.
kill_node_in_the_middle_of() {
    local job=$1 node waited
    sh "$job/submit.sh" >>slurm.log
    for waited in $(seq 60); do
        node=$(squeue -h -t RUNNING -o %N | head -n 1)
        [ -z "$node" ] || break
        sleep 1
    done
    sleep 5
    kill -9 "$(cat "$slurm/$node.outside")"
    rm "$slurm/$node.outside"
    for waited in $(seq 600); do
        squeue -h -r -o %A | xargs -r -n 1 scontrol show job -o 2>/dev/null | grep -o 'Restarts=[0-9]*' | tr R r >>"$job.restarts" || true
        [ -n "$(squeue -h)" ] || return 0
        sleep 1
    done
    squeue >&2
    return 1
}
