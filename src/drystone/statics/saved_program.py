"""The program of a model as a file: what no solver could solve is saved for a report (E140)."""

from pathlib import Path

import numpy as np

from drystone.statics.loads import Loads
from drystone.statics.model import RigidBlockModel
from drystone.statics.program import EquilibriumProgram, assemble

_ARRAYS = ("rows", "start", "index", "value", "rhs", "friction")


def save_program(model: RigidBlockModel, loads: Loads | None, path: Path) -> None:
    """Write the linear program of a model, without any picture of the wall, as NPZ.

    Parameters
    ----------
    model : RigidBlockModel
        With at least one free block.
    loads : Loads or None
        None for the tilting table.
    path : Path
        File to write.
    """
    program = assemble(model, loads)
    arrays = {name: getattr(program, name) for name in _ARRAYS}
    scales = np.array([program.length, program.weight])
    ids = np.array(program.block_ids, np.int64)
    with path.open("wb") as file:
        np.savez_compressed(file, block_ids=ids, scales=scales, **arrays)


def load_program(path: Path) -> EquilibriumProgram:
    """Read what :func:`save_program` wrote."""
    with np.load(path) as saved:  # noqa: TID251 - what this module wrote
        length, weight = saved["scales"].tolist()
        arrays = {name: saved[name] for name in _ARRAYS}
        return EquilibriumProgram(
            block_ids=tuple(saved["block_ids"].tolist()), length=length, weight=weight, **arrays
        )
