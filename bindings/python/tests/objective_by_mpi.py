"""The search of `objective` with the processes of an MPI job: prints what is found, and by how many ranks."""

from mpi4py.futures import MPIPoolExecutor

import objective


def rank(_):
    from mpi4py import MPI

    return MPI.COMM_WORLD.Get_rank()


if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        genes, squares = objective.search(executor)
        print(*[value.hex() for value in [*map(float, genes), float(squares)]])
        print(sorted(set(executor.map(rank, range(200)))))
