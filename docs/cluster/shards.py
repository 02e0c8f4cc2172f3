"""A study with HyperQueue (pip install hyperqueue): each task computes one shard.

    python shards.py 16 problem.toml --bootstrap --profile

Without a server in HQ_SERVER_DIR, server and worker run in this process, on this machine.
"""

import os
import subprocess
import sys

from hyperqueue import Client, Job, LocalCluster


def submit(client, gapi, count, arguments):
    job = Job(max_fails=count)
    for number in range(1, count + 1):
        out = os.path.abspath(f"shards/{number}")
        resume = ["--resume"] if os.path.exists(f"{out}/run.journal") else []
        shard = ["--shard", f"{number}/{count}", "--out", out, "--threads", "1", "--quiet"]
        job.program(
            [gapi, "identify", *arguments, *shard, *resume],
            cwd=os.getcwd(),
            stdout=os.path.abspath(f"shard-{number}.out"),
            stderr=os.path.abspath(f"shard-{number}.err"),
        )
    client.wait_for_jobs([client.submit(job)])


def main():
    count, arguments = int(sys.argv[1]), sys.argv[2:]
    gapi = os.environ.get("GAPI", "gapi")
    if "HQ_SERVER_DIR" in os.environ:
        submit(Client(os.environ["HQ_SERVER_DIR"]), gapi, count, arguments)
    else:
        with LocalCluster() as cluster:
            cluster.start_worker()
            submit(cluster.client(), gapi, count, arguments)
    shards = [f"shards/{number}" for number in range(1, count + 1)]
    sys.exit(subprocess.call([gapi, "report", "--merge", *shards, "--out", "study"]))


if __name__ == "__main__":
    main()
