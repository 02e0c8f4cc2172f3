"""Writes h5py_v73.mat in the layout of MATLAB's version 7.3: HDF5 behind a head of 512 bytes, with
chunks, gzip, shuffle and checksums. python3 make_v73.py (pip install h5py)"""
import h5py
import numpy as np

NAME = "h5py_v73.mat"
A = np.array([[1.5, -2, 3.25], [4, 5, -6.5]])
t = np.arange(300)/10.


def put(group, name, values, matlab_class, **options):
    dataset = group.create_dataset(name, data=values, **options)
    dataset.attrs["MATLAB_class"] = np.bytes_(matlab_class)
    return dataset


with h5py.File(NAME, "w", userblock_size=512, libver="earliest") as f:
    put(f, "A", A.T, "double")
    put(f, "f4", A.T.astype("f4"), "single")
    put(f, "i2", A.T.astype("i2"), "int16")
    put(f, "u8", np.abs(A.T).astype("u8"), "uint64")
    put(f, "flag", (A.T > 0).astype("u1"), "logical").attrs["MATLAB_int_decode"] = np.int32(1)
    put(f, "text", np.array([[104], [101], [108], [108], [111]], dtype="u2"), "char").attrs["MATLAB_int_decode"] = np.int32(2)
    put(f, "shuffled", np.vstack([t, t*t]), "double", chunks=(1, 70), compression="gzip", shuffle=True)
    put(f, "checked", np.vstack([t, t*t]), "double", chunks=(2, 64), compression="gzip", compression_opts=3, fletcher32=True)
    put(f, "empty", np.array([0, 3], dtype="u8"), "double").attrs["MATLAB_empty"] = np.uint8(1)
    run = f.create_group("run")
    run.attrs["MATLAB_class"] = np.bytes_("struct")
    put(run, "t", np.array([[0., 1, 2]]), "double")
    put(f, "z", np.zeros((2, 1), dtype=[("real", "f8"), ("imag", "f8")]), "double")
    put(f, "cube", np.arange(24.).reshape(2, 3, 4), "double")
    cell = f.create_dataset("cell", (1, 2), dtype=h5py.ref_dtype)
    cell.attrs["MATLAB_class"] = np.bytes_("cell")
    refs = f.create_group("#refs#")
    put(refs, "a", np.array([[1.]]), "double")
    cell[0, 0] = refs["a"].ref
    sparse = f.create_group("sparse")
    sparse.attrs["MATLAB_class"] = np.bytes_("double")
    sparse.attrs["MATLAB_sparse"] = np.uint64(3)
    put(sparse, "data", np.array([1.]), "double")
head = bytearray(open(NAME, "rb").read())
head[:128] = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Tue Mar 05 10:12:00 2024 HDF5 schema 1.00 .".ljust(116) + bytes(8) + b"\x00\x02IM"
open(NAME, "wb").write(head)
