import json
from pathlib import Path

import pytest

from drystone.errors import DrystoneError
from drystone_lab.runs.outcome import RunOutcome, RunStore, execute
from tests.lab.runs.bricks import run


@pytest.fixture(scope="module")
def outcome() -> RunOutcome:
    return execute(run(1), None)


def test_what_was_kept_is_found(tmp_path: Path, outcome: RunOutcome) -> None:
    store = RunStore(tmp_path / "new" / "folder")
    assert store.get(outcome.key) is None
    store.put(outcome)
    found = RunStore(store.folder).get(outcome.key)
    assert found is not None
    assert found.key == outcome.key
    assert (found.figures, found.times) == (outcome.figures, outcome.times)
    assert found.plan == outcome.plan
    assert store.get(run(2).key) is None


def without(text: str, *names: str) -> str:
    data = json.loads(text)
    part = data
    for name in names[:-1]:
        part = part[name]
    del part[names[-1]]
    return json.dumps(data)


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text[: len(text) // 2],
        lambda _: "null",
        lambda _: '{"figures": 1, "plan": 2, "times": 3}',
        lambda text: "\udcff" + text,
        lambda text: without(text, "plan", "steps"),
        lambda text: without(text, "times", "wall"),
        lambda text: without(text, "figures", "F_LR"),
    ],
)
def test_a_damaged_file_is_named_with_the_cure(tmp_path: Path, outcome: RunOutcome, damage) -> None:
    store = RunStore(tmp_path)
    store.put(outcome)
    (path,) = tmp_path.iterdir()
    path.write_text(damage(path.read_text("utf-8")), "utf-8", errors="surrogateescape")
    with pytest.raises(DrystoneError) as caught:
        store.get(outcome.key)
    assert (caught.value.code, caught.value.where) == ("E401", str(path))
    assert "Delete the file" in caught.value.cure
