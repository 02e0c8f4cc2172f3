"""Writes the files result_*.mat; needs numpy and scipy."""
import numpy as np
from scipy.io import savemat

names = ["Time", "p", "x", "minus_x", "same_x", "minus_p"]
descriptions = ["Time in [s]", "parameter [m]", "state [Pa|bar]", "", "alias", ""]
info = np.array([[0, 1], [1, 2], [2, 2], [2, -2], [2, 2], [1, -2]])
info = np.hstack([info, np.tile([0, -1], (len(names), 1))]).astype("i4")
data_1 = np.array([[0.0, 2.5], [1.0, 2.5]])
data_2 = np.array([[0.0, 1.0], [0.5, 2.0], [0.5, -2.0], [1.0, -3.0]])

def text(lines):
    width = max(len(line) for line in lines)
    return np.array([list(line.ljust(width)) for line in lines])

for kind in ["binTrans", "binNormal"]:
    turn = (lambda m: np.ascontiguousarray(m.T)) if kind == "binTrans" else (lambda m: m)
    for precision, dtype in [("double", "f8"), ("single", "f4")]:
        savemat(f"result_{kind}_{precision}.mat", {
            "Aclass": text(["Atrajectory", "1.1", "", kind]),
            "name": turn(text(names)), "description": turn(text(descriptions)),
            "dataInfo": turn(info),
            "data_1": turn(data_1.astype(dtype)), "data_2": turn(data_2.astype(dtype)),
        }, format="4")
