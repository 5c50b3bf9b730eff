"""Changes of JSON as a tree: numbers, keys, nesting, and pictures that stand in it as text."""

import base64
import json
from collections.abc import Sequence
from copy import deepcopy
from random import Random
from typing import Any

from fuzz.containers import PNG, change_png
from fuzz.raw import BYTES, LARGEST, NUMBERS, ODD, STRANGE, near_number


class Text(str):
    """What is written as it is: a number as it was read, or what is no JSON."""


class Pairs(list[list[Any]]):
    """An object as keys and values; a key may be there twice."""


def change_json(data: bytes, rng: Random, pool: Sequence[bytes]) -> bytes:
    """Change one to three values, keys or lists."""
    root = [_read(data)]
    for _ in range(rng.choice((1, 1, 2, 3))):
        _change(root, rng, pool)
    return "".join(map(_written, root)).encode()


def _read(data: bytes) -> Any:
    return json.loads(
        data, object_pairs_hook=lambda found: Pairs(map(list, found)),
        parse_int=Text, parse_float=Text, parse_constant=Text,
    )  # fmt: skip


def _written(node: Any) -> str:
    if isinstance(node, Text):
        return node
    if isinstance(node, Pairs):
        return "{" + ",".join(f"{json.dumps(key)}:{_written(value)}" for key, value in node) + "}"
    if isinstance(node, list):
        return "[" + ",".join(map(_written, node)) + "]"
    return json.dumps(node)


def _change(root: list[Any], rng: Random, pool: Sequence[bytes]) -> None:
    """Change a place of the tree: a value of an object in half of the cases, however few."""
    todo, places, named = [root], [], []
    for node in todo:
        for i, item in enumerate(node):
            holder, at = (item, 1) if isinstance(node, Pairs) else (node, i)
            (named if holder is item else places).append((holder, at, node, i))
            if isinstance(holder[at], list):
                todo.append(holder[at])
    chosen = named if named and rng.random() < 0.5 else places + named
    holder, at, node, i = rng.choice(chosen)
    draw = rng.randrange(10)
    if draw == 0:
        del node[i]
    elif draw == 1:
        most = LARGEST // len(_written(holder[at]))
        # Copies: what is changed in one later must not grow in all.
        count = min(most, rng.choice((1, 1, 2, 50, 2000)))
        node[i:i] = [deepcopy(node[i]) for _ in range(count)]
    elif draw == 2 and isinstance(node, Pairs):
        node[i] = [rng.choice((*ODD, *(key for key, *_ in node))), node[i][1]]
    elif draw == 3:
        other, index, *_ = rng.choice(places + named)
        holder[at], other[index] = other[index], holder[at]
    elif draw == 4:
        holder[at] = _nested(_written(holder[at]), rng)
    else:
        holder[at] = _other(holder[at], rng, pool)


def _nested(inner: str, rng: Random) -> Text:
    depth = rng.choice((1, 1, 2, 60, 400, 900, 5000))
    left, right = rng.choice((("[", "]"), ('{"a":', "}"), ("[0,", "]"), ('{"type":', "}")))
    return Text(left * depth + inner + right * depth)


def _other(value: Any, rng: Random, pool: Sequence[bytes]) -> Any:
    """Return another value, of the same kind in most cases."""
    if isinstance(value, Text):
        if rng.random() < 0.5:
            return Text(near_number(value, rng))
        return Text(rng.choice((*NUMBERS, *STRANGE[:3])))
    if isinstance(value, str) and rng.random() < 0.8:
        return _other_text(value, rng, pool)
    if isinstance(value, list) and rng.random() < 0.7:
        most = LARGEST // len(_written(value))
        count = min(most, rng.choice((0, 1, 2, 3, 100)))
        value = [deepcopy(item) for _ in range(count) for item in value]
        rng.shuffle(value)
        return value
    return rng.choice((None, True, False, [], Pairs(), [[]], "", "7", Text("7"), Text("0.5")))


def _other_text(value: str, rng: Random, pool: Sequence[bytes]) -> str:
    if len(value) > 40:
        try:
            data = base64.b64decode(value, validate=True)
        except ValueError:
            pass
        else:
            change = change_png if data.startswith(PNG) else rng.choice(BYTES)
            data = rng.choice(pool) if rng.random() < 0.2 else change(data, rng, pool)
            return base64.b64encode(data).decode()
    if rng.random() < 0.5:
        return rng.choice((*ODD, value + rng.choice(ODD)))
    return rng.choice(BYTES)(value.encode("utf-8", "replace"), rng, pool).decode("latin-1")
