"""What lies beside a plan while it is made: what it is made of, and where its search stands.

`plan --resume` goes on from it; a finished plan has none.  It is plain JSON, and what is read is
checked as if anybody had written it.
"""

import json
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from typing import Any

from drystone.errors import PlanError
from drystone.io.json_text import as_json, from_plain
from drystone.planner.search_settings import SearchSettings
from drystone.search.operators import OPERATORS
from drystone.search.packed import PackedWall
from drystone.search.state import SearchState
from drystone.whole_files import write_whole

CHECKPOINT = "checkpoint.json"
SCHEMA = "drystone-checkpoint/2"

LARGEST_BYTES = 200_000_000
"""No search of ours writes so much; what is larger is not read."""


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """A plan that is being made."""

    made_of: Mapping[str, Any]
    """All that shapes the plan: stones, wall, seed, settings, of JSON's own types."""
    state: SearchState | None = None
    """Where its search stands; None while there is but a first wall."""


def write_checkpoint(checkpoint: Checkpoint, folder: Path) -> None:
    """Write a checkpoint into the folder of its plan."""
    kept = {
        "schema": SCHEMA,
        "version": version("drystone"),
        "made_of": checkpoint.made_of,
        "search": checkpoint.state,
    }
    data = as_json(kept)
    text = f'{{"sha256": "{_digest(data)}",\n"data": {data}}}\n'
    write_whole(folder / CHECKPOINT, text.encode())


def read_checkpoint(
    folder: Path, stone_ids: Collection[int], search: SearchSettings
) -> Checkpoint | None:
    """Read the checkpoint in the folder of a plan, if there is one.

    One that is damaged, of another program, or of another version of this one is refused (E207).
    """
    path = folder / CHECKPOINT
    if not path.is_file():
        return None
    try:
        if path.stat().st_size > LARGEST_BYTES:
            raise ValueError("it is too large")
        data = _data(path.read_bytes())
        state = None if data["search"] is None else from_plain(SearchState, data["search"])
        if state is not None:
            _check(state, frozenset(stone_ids), search)
    except (OSError, ValueError, RecursionError) as error:
        what = f"the search cannot go on from it: {error}."
        cure = "Remove it and give the same command again: the partial plan is gone on from."
        raise PlanError("E207", what, where=str(path), cure=cure) from error
    return Checkpoint(data["made_of"], state)


def _digest(text: str) -> str:
    return sha256(text.encode()).hexdigest()


def _data(text: bytes) -> Mapping[str, Any]:
    """Return what a file holds, if it is one of ours and as it was written."""
    whole = json.loads(text)
    if not isinstance(whole, dict) or whole.keys() != {"sha256", "data"}:
        raise ValueError("it is not a checkpoint")
    data = whole["data"]
    if _digest(as_json(data)) != whole["sha256"]:
        raise ValueError("it is damaged")
    names = {"schema", "version", "made_of", "search"}
    if not isinstance(data, dict) or data.keys() != names or data["schema"] != SCHEMA:
        raise ValueError("it is not a checkpoint that this drystone knows")
    if data["version"] != version("drystone"):
        raise ValueError(f"it is of drystone {str(data['version'])[:20]}")
    if not isinstance(data["made_of"], dict):
        raise ValueError("it does not say what it is of")
    return data


def _check(state: SearchState, stone_ids: frozenset[int], search: SearchSettings) -> None:
    """Raise ValueError where a search cannot be so."""
    chains, found = state.chains, state.found
    if (state.number == 0) != (state.before is None) or state.number < 0:
        raise ValueError("its rounds do not follow each other")
    if (chains is None) != bool(found) or len(found) > search.passes:
        raise ValueError("it has not the first walls of a round")
    if chains is not None and not (
        len(chains.links) == search.chains
        and 0 <= chains.turn <= search.chains
        and all(link.done >= 0 and link.number >= 0 for link in chains.links)
        and all(
            len(one.uses) == len(one.helped) == len(OPERATORS)
            for link in chains.links
            for one in (link.known, link.learnt)
        )
    ):
        raise ValueError("its chains are not those of the settings")
    for wall in _walls(state):
        ids = [group.stone_id for group in wall.groups]
        ends = (0, *wall.courses.ends, len(ids)) if wall.courses else ()
        if not stone_ids.issuperset(ids) or len(set(ids)) < len(ids):
            raise ValueError("a wall is of other stones")
        if list(ends) != sorted(ends):
            raise ValueError("the courses of a wall are out of order")


def _walls(state: SearchState) -> Iterator[PackedWall]:
    chains = state.chains
    yield from state.found
    for reached in (state.before, chains.reached if chains else None):
        yield from () if reached is None else (reached.best, *reached.kept)
    for link in chains.links if chains else ():
        yield from (link.now, link.best, *link.kept)
