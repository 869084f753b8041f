#!/usr/bin/python3
"""slurm_test.py PROJECT SIMULATOR: a Slurm of one node on this host, in a folder of its own, and a sweep that Snakemake's
profile of analysis/sweep/slurm runs on it: each point once, a job of Slurm's. Where Slurm, munge or Snakemake is not
there, or Slurm does not start here: skipped (exit code 77), with the reason."""
import os
import pwd
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import small_sweep

SIMULATOR, PROJECT = os.path.abspath(sys.argv.pop()), os.path.abspath(sys.argv.pop())
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "sinfo", "snakemake")
PATH = os.pathsep.join([os.environ["PATH"], "/usr/sbin", "/sbin"])
# A root of every list of controllers, no accounting, no cgroups: what one node for one test needs.
CONFIGURATION = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/jobs
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class NoSlurm(Exception):
    """Why it does not run here."""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Slurm:
    """munged, slurmctld and slurmd as children of this process."""

    def __init__(self, folder):
        self.folder, self.children = folder, []
        self.environment = dict(os.environ, PATH=PATH, SLURM_CONF=os.path.join(folder, "slurm.conf"))

    def start(self):
        for name in ("munge", "state", "spool"):
            os.mkdir(os.path.join(self.folder, name), 0o755)
        os.chmod(self.folder, 0o755)  # munged refuses what others may write to
        host = socket.gethostname().partition(".")[0]
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") >> 20
        with open(self.environment["SLURM_CONF"], "w", encoding="utf-8") as file:
            file.write(CONFIGURATION.format(host=host, folder=self.folder, user=pwd.getpwuid(os.getuid()).pw_name,
                                            ports=free_ports(2), cpus=os.cpu_count(), memory=memory))
        self.start_munge()
        self.child("slurmctld", "-D", "-c", "-L", os.path.join(self.folder, "slurmctld.log"))
        self.child("slurmd", "-D", "-N", host, "-L", os.path.join(self.folder, "slurmd.log"))
        self.wait("the node to be idle", lambda: self.ask("sinfo", "-h", "-o", "%T") == "idle")

    def start_munge(self):
        folder = os.path.join(self.folder, "munge")
        with open(os.open(os.path.join(folder, "key"), os.O_WRONLY | os.O_CREAT, 0o600), "wb") as file:
            file.write(os.urandom(1024))
        as_munge = []
        if os.getuid() == 0:  # which munged does not like to be
            try:
                munge = pwd.getpwnam("munge")
            except KeyError:
                raise NoSlurm("there is no user munge") from None
            for path in (folder, os.path.join(folder, "key")):
                os.chown(path, munge.pw_uid, munge.pw_gid)
            as_munge = ["runuser", "-u", "munge", "--"]
        paths = [f"--{what}-file={folder}/{what}" for what in ("key", "pid", "log", "seed")]
        self.child(*as_munge, "munged", "--foreground", f"--socket={folder}/socket", *paths)
        self.wait("munge's socket", lambda: os.path.exists(os.path.join(folder, "socket")))

    def child(self, *command):
        log = open(os.path.join(self.folder, "daemons.log"), "a", encoding="utf-8")  # noqa: SIM115: the child's
        with log:
            self.children.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log))

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, check=False).stdout.strip()

    def wait(self, what, is_there, seconds=60):
        end = time.monotonic() + seconds
        while not is_there():
            ended = [child.args for child in self.children if child.poll() is not None]
            if ended or time.monotonic() > end:
                raise NoSlurm(f"waited for {what}; {' '.join(ended[0]) + ' ended' if ended else 'it did not come'}: "
                              + self.last_words())
            time.sleep(0.1)

    def last_words(self):
        out = []
        for name in ("daemons.log", "slurmctld.log", "slurmd.log", "munge/log"):
            try:
                with open(os.path.join(self.folder, name), encoding="utf-8", errors="replace") as file:
                    out += [f"{name}: {line.strip()}" for line in file.readlines()[-2:]]
            except OSError:
                pass
        return "; ".join(out)

    def stop(self):
        for child in reversed(self.children):
            child.terminate()
        for child in self.children:
            try:
                child.wait(timeout=20)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()


class SweepOnSlurm(unittest.TestCase):
    def test_each_point_is_a_job(self):
        work = os.path.join(FOLDER, "work")
        os.mkdir(work)
        small_sweep.write(work, PROJECT)
        command = small_sweep.snakemake(PROJECT, SIMULATOR, "out/sweep", "--profile", os.path.join(PROJECT, "analysis/sweep/slurm"))
        done = subprocess.run(command, cwd=work, env=small_sweep.environment(work, SLURM.environment), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=500, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + SLURM.last_words())
        small_sweep.check_collected(self, os.path.join(work, "out/sweep"))
        # Slurm's own list: four jobs, one a point, each of one core, and none failed.
        with open(os.path.join(FOLDER, "jobs"), encoding="utf-8") as file:
            jobs = [dict(word.partition("=")[::2] for word in line.split()) for line in file]
        self.assertEqual([job["JobState"] for job in jobs], ["COMPLETED"] * 4)
        self.assertEqual([job["ProcCnt"] for job in jobs], ["1"] * 4)
        self.assertEqual(len({job["JobId"] for job in jobs}), 4)
        self.assertEqual(len(os.listdir(os.path.join(work, "out/slurm"))), 4)


def main():
    global FOLDER, SLURM
    missing = [program for program in PROGRAMS if shutil.which(program, path=PATH) is None]
    if missing:
        print(f"skipped: there is no {', '.join(missing)}; ./test.sh --all installs slurm-wlm, munge and snakemake")
        return 77
    with tempfile.TemporaryDirectory() as FOLDER:
        SLURM = Slurm(FOLDER)
        try:
            SLURM.start()
        except NoSlurm as why:
            print(f"skipped: Slurm does not start here: {why}")
            return 77
        else:
            return 0 if unittest.main(exit=False).result.wasSuccessful() else 1
        finally:
            SLURM.stop()


if __name__ == "__main__":
    sys.exit(main())
