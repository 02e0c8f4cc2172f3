"""Executors of `concurrent.futures` in other processes: the same search as alone."""

import multiprocessing
import os
import shutil
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import objective

FOLDER = Path(__file__).resolve().parent


@pytest.fixture(scope="module")
def alone():
    genes, squares = objective.search()
    assert squares < objective.squares([1.0, 1.0]) / 20
    return genes, squares


def same(found, alone):
    np.testing.assert_array_equal(found[0], alone[0])
    assert found[1] == alone[1]


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_processes(alone, method):
    context = multiprocessing.get_context(method)
    with ProcessPoolExecutor(2, mp_context=context) as executor:
        same(objective.search(executor), alone)


def test_dask(alone):
    distributed = pytest.importorskip("distributed")
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        client.wait_for_workers(2, timeout=120)
        assert len(set(client.run(os.getpid).values()) - {os.getpid()}) == 2
        same(objective.search(client.get_executor()), alone)


def test_mpi(alone):
    pytest.importorskip("mpi4py.futures")
    if not shutil.which("mpiexec"):
        pytest.skip("there is no mpiexec")
    path = os.pathsep.join([str(FOLDER), *filter(None, [os.environ.get("PYTHONPATH")])])
    # The settings of Open MPI for machines with fewer cores than ranks; others do not know them.
    settings = {
        "PYTHONPATH": path,
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    }
    job = ["mpiexec", "-n", "3", sys.executable, "-m", "mpi4py.futures", str(FOLDER / "objective_by_mpi.py")]
    ended = subprocess.run(job, env={**os.environ, **settings}, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    found, ranks = ended.stdout.splitlines()
    *genes, squares = map(float.fromhex, found.split())
    same((genes, squares), alone)
    # The first rank asks, the others simulate.
    assert set(ranks.strip("[]").split(", ")) <= {"1", "2"}
