"""Slow, obvious twin of drystone.statics.flow.central_path: all unknowns, one t after another."""

import numpy as np


def end_of_path(normal, slip, live, rhs, closing, t_end):
    """Velocity where all products are t_end, by Newton's method from t = 1 on.

    Only where t falls all along the curve; the arguments are dense.
    """
    rows, m = normal.shape
    a, b, u, p, q = np.ones((5, m))
    v, alpha, t = live / (live @ live), 0.0, 1.0
    eye, none = np.eye(m), np.zeros((m, m))
    blank, column = np.zeros((m, rows)), np.zeros((m, 1))
    while True:
        for _ in range(200):
            left = np.concatenate(
                (
                    live * alpha + normal @ (a + b) + slip @ (a - b) - rhs,
                    [live @ v - 1.0],
                    normal.T @ v + closing * t**0.75 - u,
                    slip.T @ v - p + q,
                    (a + b) * u - t,
                    a * p - t,
                    b * q - t,
                )
            )
            if np.abs(left).max() < 1e-3 * t:
                break
            nothing, forces = np.zeros((1, m)), np.zeros((rows, m))
            square, row = np.zeros((rows, rows)), np.zeros((1, 1))
            matrix = np.block(
                [
                    [normal + slip, normal - slip, forces, forces, forces, square, live[:, None]],
                    [nothing, nothing, nothing, nothing, nothing, live[None], row],
                    [none, none, -eye, none, none, normal.T, column],
                    [none, none, none, -eye, eye, slip.T, column],
                    [np.diag(u), np.diag(u), np.diag(a + b), none, none, blank, column],
                    [np.diag(p), none, none, np.diag(a), none, blank, column],
                    [none, np.diag(q), none, none, np.diag(b), blank, column],
                ]
            )
            change = np.linalg.solve(matrix, -left)
            inside = np.concatenate((a, b, u, p, q))
            step = min(1.0, 0.9 / np.abs(change[: 5 * m] / inside).max())
            a, b, u, p, q = (inside + step * change[: 5 * m]).reshape(5, m)
            v, alpha = v + step * change[5 * m : -1], alpha + step * change[-1]
        if t <= t_end:
            return v
        t = max(t / 3.0, t_end)
