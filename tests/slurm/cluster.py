"""A Slurm cluster of two nodes on this machine alone, in a temporary folder, for the time of a test.

Needs to be root: slurmd does. Nothing of it stays, and nothing of an existing Slurm or munge is touched."""

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from waiting import InVain, wait_until  # noqa: E402

SKIPPED = 77
PROGRAMS = ["slurmctld", "slurmd", "munged", "sbatch", "squeue", "scancel"]


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def install():
    """Installs Slurm where it is missing, without starting its services."""
    if os.geteuid() != 0:
        skip("slurmd runs as root only; run the tests as root to have this one")
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    if all(shutil.which(program) for program in PROGRAMS):
        return
    if not shutil.which("apt-get"):
        skip("Slurm is not installed, and there is no apt-get to install it with")
    policy = Path("/usr/sbin/policy-rc.d")
    own_policy = not policy.exists()
    if own_policy:
        policy.write_text("#!/bin/sh\nexit 101\n")
        policy.chmod(0o755)
    try:
        for words in ("update", "install -y --no-install-recommends slurm-wlm munge"):
            ended = subprocess.run(["apt-get", "-qq", "-o", "DPkg::Lock::Timeout=300", *words.split()],
                                   env=dict(os.environ, DEBIAN_FRONTEND="noninteractive"), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            if ended.returncode:
                skip(f"apt-get {words}: {ended.stderr.strip()}")
    finally:
        if own_policy:
            policy.unlink()


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for s in sockets:
            s.bind(("127.0.0.1", 0))
        return [s.getsockname()[1] for s in sockets]


def environment_of(pid):
    try:
        return Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return []


def processes():
    return [int(entry.name) for entry in Path("/proc").iterdir() if entry.name.isdigit()]


class Cluster:
    """with Cluster() as cluster: …; `cluster.environment` is for those who talk to it."""

    nodes = ("n1", "n2")

    def __init__(self):
        self.folder = Path(tempfile.mkdtemp(prefix="drape_slurm_"))
        self.folder.chmod(0o755)
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))
        self.mark = f"SLURM_CONF={self.folder}/slurm.conf".encode()
        self.daemons, self.killed = {}, set()

    def __enter__(self):
        try:
            self.start_munge()
            self.configure()
            self.start("slurmctld", ["slurmctld", "-D"])
            for node in self.nodes:
                self.start(node, ["slurmd", "-D", "-N", node])
            self.wait_until("both nodes are idle", lambda: self.states().count("idle") == 2)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for name in reversed(list(self.daemons)):
            self.daemons[name].terminate()
        for daemon in self.daemons.values():
            try:
                daemon.wait(timeout=60)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        self.kill(processes())  # steps and their runs
        if sys.exc_info()[0] and os.environ.get("DRAPE_KEEP_SLURM"):
            print(f"kept: {self.folder}")
            return
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, name, words):
        log = open(self.folder / f"{name}.out", "ab")
        self.daemons[name] = subprocess.Popen(words, env=self.environment, stdin=subprocess.DEVNULL,
                                              stdout=log, stderr=log, start_new_session=True)

    def start_munge(self):
        munge = self.folder / "munge"
        munge.mkdir(mode=0o755)
        self.socket = munge / "socket"
        (munge / "key").write_bytes(os.urandom(128))
        (munge / "key").chmod(0o400)
        for path in (munge, munge / "key"):
            shutil.chown(path, "munge", "munge")
        self.start("munged", ["setpriv", "--reuid=munge", "--regid=munge", "--clear-groups", "munged",
                              "--foreground", "--force", f"--socket={self.socket}", f"--key-file={munge}/key",
                              f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed"])
        self.wait_until("munged listens", self.socket.exists)

    def configure(self):
        ports = free_ports(3)
        for name in ("state", "spool.n1", "spool.n2"):
            (self.folder / name).mkdir()
        nodes = "".join(f"NodeName={node} NodeHostname=localhost NodeAddr=127.0.0.1 Port={port} CPUs=1 "
                        "RealMemory=2000 State=UNKNOWN\n" for node, port in zip(self.nodes, ports[1:]))
        (self.folder / "slurm.conf").write_text(f"""ClusterName=drape_test
SlurmctldHost=localhost
SlurmctldPort={ports[0]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={self.socket}
CredType=cred/munge
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool.%n
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/%n.pid
SlurmctldLogFile={self.folder}/slurmctld.log
SlurmdLogFile={self.folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SlurmdParameters=config_overrides
SlurmdTimeout=5
SlurmctldTimeout=5
KillWait=5
SchedulerTimeSlice=5
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1,bf_interval=1
{nodes}PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
""")

    def call(self, *words):
        return subprocess.run(words, env=self.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)

    def states(self):
        return self.call("sinfo", "--noheader", "--Node", "--format=%T").stdout.split()

    def wait_until(self, what, holds):
        def holds_with_all_daemons():
            for name, daemon in self.daemons.items():
                if daemon.poll() is not None and name not in self.killed:
                    raise RuntimeError(f"{name} has ended before: {what}; logs:\n{self.logs()}")
            return holds()
        try:
            wait_until(what, holds_with_all_daemons)
        except InVain as fault:
            raise RuntimeError(f"{fault}; logs:\n{self.logs()}") from None

    def logs(self):
        return "".join(f"--- {log.name}\n{log.read_text(errors='replace')[-3000:]}\n"
                       for log in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out")))

    def tasks_on(self, node):
        """Processes of jobs on that node."""
        on_node = f"SLURMD_NODENAME={node}".encode()
        return [pid for pid in processes() if self.mark in environment_of(pid) and on_node in environment_of(pid)]

    def kill_node(self, node):
        """As if its power were cut: the daemon, then what it has started."""
        tasks = self.tasks_on(node)
        steps = [int(Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[1]) for pid in tasks
                 if Path(f"/proc/{pid}/stat").exists()]
        self.killed.add(node)
        self.daemons[node].kill()
        self.daemons[node].wait()
        self.kill(steps + tasks + self.tasks_on(node))

    def kill(self, pids):
        """Those that know of this cluster."""
        for pid in pids:
            if pid > 1 and pid != os.getpid() and self.mark in environment_of(pid):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
