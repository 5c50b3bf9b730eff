"""steps.parquet: the build list with types, and units and scale in its metadata."""

import io
from importlib import import_module
from pathlib import Path
from typing import Any

from drystone.drawing.assembly.parts import Assembly
from drystone.drawing.export.out import put
from drystone.drawing.export.rows import columns
from drystone.drawing.export.settings import ExportSettings
from drystone.errors import UsageError

FILE = "steps.parquet"


def files(assembly: Assembly, settings: ExportSettings) -> tuple[str, ...]:  # noqa: ARG001
    """Return the names that will be written; E181 when pyarrow is not installed."""
    load_arrow()
    return (FILE,)


def write(assembly: Assembly, folder: Path, settings: ExportSettings) -> tuple[Path, ...]:  # noqa: ARG001
    """Write the table."""
    arrow, parquet = load_arrow()
    types = {int: arrow.int64(), float: arrow.float64(), str: arrow.string(),
             list: arrow.list_(arrow.int64())}  # fmt: skip
    table = columns(assembly)
    schema = arrow.schema(
        [(column.name, types[column.type]) for column in table], metadata=_about(assembly)
    )
    arrays = [arrow.array(column.values, types[column.type]) for column in table]
    data = io.BytesIO()
    parquet.write_table(arrow.Table.from_arrays(arrays, schema=schema), data)
    return (put(folder, FILE, data.getvalue()),)


def load_arrow() -> tuple[Any, Any]:
    """Return pyarrow and its module for Parquet; they are an extra.

    Raises
    ------
    UsageError
        E181 when it is not installed.
    """
    try:
        return import_module("pyarrow"), import_module("pyarrow.parquet")
    except ImportError as error:
        raise UsageError(
            "E181",
            "pyarrow is not installed, and it writes Parquet.",
            where=FILE,
            cure='Install it with `pip install "drystone[io]"`, or write csv.',
        ) from error


def _about(assembly: Assembly) -> dict[str, str]:
    plan = assembly.plan
    return {
        "drystone": plan.version,
        "source": str(plan.source.get("path") or ""),
        "sha256": str(plan.source.get("sha256") or ""),
        "unit": assembly.unit,
        "px_per_m": str(assembly.px_per_m or ""),
        "thickness": repr(assembly.thickness),
        "density_kg_m3": repr(assembly.density_kg_m3),
    }
