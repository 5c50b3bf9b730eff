"""Slow, obvious twin of drystone.statics.flow.central_path: all unknowns, one t after another."""

import numpy as np


def end_of_path(normal, slip, live, rhs, closing, t_end):
    """Velocity where all products are t_end, by Newton's method from t = 1 on.

    Only where t falls all along the curve; the arguments are dense.
    """
    m, t = normal.shape[1], 1.0
    at = np.concatenate((np.ones(5 * m), live / (live @ live), [0.0]))

    def left(at):
        a, b, u, p, q = at[: 5 * m].reshape(5, m)
        v, alpha = at[5 * m : -1], at[-1]
        return np.concatenate(
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

    while True:
        for _ in range(200):
            if np.abs(left(at)).max() < 1e-3 * t:
                break
            # Slopes by steps along the imaginary axis: nothing is taken away, so no digit is lost.
            slopes = np.array([left(at + one).imag for one in 1e-30j * np.eye(len(at))]) / 1e-30
            change = np.linalg.solve(slopes.T, -left(at))
            at = at + min(1.0, 0.9 / np.abs(change[: 5 * m] / at[: 5 * m]).max()) * change
        if t <= t_end:
            return at[5 * m : -1]
        t = max(t / 3.0, t_end)
