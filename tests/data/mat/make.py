"""Writes the files scipy_*.mat and raw_*.mat; needs numpy and scipy."""
import struct
import numpy as np
from scipy.io import savemat

a = np.array([[1.5, -2.0, 3.25], [4.0, 5.0, -6.5]])
x = np.linspace(0.0, 1.0, 5).reshape(-1, 1)
plain = {"A": a, "x": x, "scalar": np.array([[42.0]]), "empty": np.zeros((0, 0)), "text": "hello"}
savemat("scipy_v4.mat", plain, format="4")
savemat("scipy_v4_types.mat", {
    "f4": a.astype("f4"), "i4": a.astype("i4"), "i2": a.astype("i2"),
    "u2": np.abs(a).astype("u2"), "u1": np.abs(a).astype("u1"),
    "z": a + 1j, "names": np.array(["one", "three"])}, format="4")
savemat("scipy_v4_big_endian.mat", {"A": a.astype(">f8")}, format="4")

rich = dict(plain)
for name in ["i1", "i2", "i4", "i8", "f4"]:
    rich[name] = a.astype(name)
for name in ["u1", "u2", "u4", "u8"]:
    rich[name] = np.abs(a).astype(name)
rich["flag"] = a > 0
rich["names"] = np.array(["one", "three"])
rich["accent"] = "\u00e9t\u00e9 \u03b7"
rich["s"] = {"a": a, "b": {"c": np.array([[7.0]])}, "t": "inner"}
rich["cell"] = np.array([a, "x"], dtype=object)
rich["cube"] = np.zeros((2, 2, 2))
rich["z"] = a + 1j
rich["many"] = np.array([(1.0,), (2.0,)], dtype=[("a", "f8")])
rich["big"] = np.array([[2**53 + 1]], dtype="i8")
import scipy.sparse
rich["sparse"] = scipy.sparse.csc_matrix(a)
savemat("scipy_v5.mat", rich, format="5")
savemat("scipy_v7.mat", rich, format="5", do_compression=True)
# The independent reader of the tests knows numbers only.
savemat("scipy_v7_numbers.mat", {"A": a, "x": x, "i2": a.astype("i2")}, do_compression=True)

# Forms that no common writer makes any more, byte by byte.
def v4(mopt, rows, cols, name, data, order, imag=0):
    name = name.encode() + b"\0"
    return struct.pack(order + "5i", mopt, rows, cols, imag, len(name)) + name + data

with open("raw_v4_big_endian.mat", "wb") as f:
    f.write(v4(1000, 2, 3, "A", a.T.astype(">f8").tobytes(), ">"))
    f.write(v4(1010, 2, 3, "f4", a.T.astype(">f4").tobytes(), ">"))
    f.write(v4(1020, 2, 3, "i4", a.T.astype(">i4").tobytes(), ">"))
    f.write(v4(1030, 2, 3, "i2", a.T.astype(">i2").tobytes(), ">"))
    f.write(v4(1040, 2, 3, "u2", np.abs(a).T.astype(">u2").tobytes(), ">"))
    f.write(v4(1051, 1, 5, "text", b"hello", ">"))
with open("raw_v4_rows.mat", "wb") as f:
    f.write(v4(100, 2, 3, "A", a.astype("<f8").tobytes(), "<"))
    f.write(v4(1110, 2, 3, "f4", a.astype(">f4").tobytes(), ">"))
    f.write(v4(2, 3, 3, "sparse", np.array([[1, 2, 9], [1, 2, 0], [3, 4, 0.0]]).T.astype("<f8").tobytes(), "<"))
    f.write(v4(0, 1, 1, "last", struct.pack("<d", 8.0), "<"))

# Version 5, big-endian, with a small data element for the name and for the value.
def element(kind, data):
    return struct.pack(">2I", kind, len(data)) + data + b"\0" * (-len(data) % 8)
body = (element(6, struct.pack(">2I", 6, 0)) + element(5, struct.pack(">2i", 2, 3))
        + struct.pack(">2H", 1, 1) + b"A\0\0\0"
        + element(9, a.T.astype(">f8").tobytes()))
small = (element(6, struct.pack(">2I", 6, 0)) + element(5, struct.pack(">2i", 1, 2))
         + struct.pack(">2H", 1, 1) + b"b\0\0\0" + struct.pack(">2H", 2, 2) + b"\x07\x09\0\0")
with open("raw_v5_big_endian.mat", "wb") as f:
    f.write(b"MATLAB 5.0 MAT-file, big endian".ljust(116) + b"\0" * 8 + struct.pack(">H", 0x0100) + b"MI")
    f.write(element(14, body) + element(14, small))
