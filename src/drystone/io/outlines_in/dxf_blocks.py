"""What a DXF draws: the entities of its model space, and of blocks where they are inserted."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from drystone.io.foreign import foreign
from drystone.io.outlines_in.model import damaged

_DEEPEST = 64
_MOST = 100_000
"""Entities and block references, those in rows and columns, and in blocks, one by one."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """An entity where it is drawn."""

    entity: Any  # as its block defines it
    layer: str  # its own; that of the block reference for what is on layer 0 in a block
    matrix: Any  # from its block to the model space


@dataclass(frozen=True, eq=False)
class _Place:
    """Where the entities of a block are drawn."""

    matrix: Any
    layer: str = "0"
    depth: int = 0


def drawn_entities(document: Any, where: str, aside: Counter[str]) -> list[Drawn]:
    """Return all that the model space shows; what is hidden or missing is counted.

    A block on a frozen layer is hidden with all that is in it.  On a layer that is off, only what
    has its layer from the block reference is, as CAD programs show it.
    """
    start = _Place(import_module("ezdxf.math").Matrix44())
    walk = _Walk(document, where, aside)
    with foreign(lambda why: damaged(where, f"a block or a dimension cannot be used ({why})")):
        return list(walk.drawn(document.modelspace(), start))


class _Walk:
    """Through all that is drawn."""

    def __init__(self, document: Any, where: str, aside: Counter[str]) -> None:
        self.document, self.where, self.aside = document, where, aside
        self.composite = import_module("ezdxf.protocols").SupportsVirtualEntities
        self.count = 0

    def drawn(self, entities: Iterable[Any], place: _Place) -> Iterator[Drawn]:
        """Yield entities, and the parts of those that have parts, in the order of the file."""
        for entity in entities:
            self._count(place)
            own = str(_said(entity, "layer", "0"))
            layer = place.layer if own == "0" else own
            if self._is_hidden(entity, layer):
                self.aside["entities that are hidden, or on hidden layers"] += 1
            elif entity.dxftype() == "INSERT":
                yield from self._inserted(entity, _Place(place.matrix, layer, place.depth + 1))
                yield from self.drawn(entity.attribs, place)
            elif isinstance(entity, self.composite):
                # Dimensions are blocks too, but their parts are where they are drawn.
                parts = entity.__virtual_entities__()
                yield from self.drawn(parts, _Place(place.matrix, layer, place.depth + 1))
            else:
                yield Drawn(entity, layer, place.matrix)

    def _inserted(self, insert: Any, place: _Place) -> Iterator[Drawn]:
        block = self.document.blocks.get(insert.dxf.get("name", ""))
        if block is None:
            self.aside["INSERT of a block that is not there"] += 1
            return
        if block.block.is_xref or block.block.is_xref_overlay:
            # What it shows is in another file; a copy of it here would be of some earlier day.
            self.aside["INSERT of an external reference"] += 1
            return
        # Definitions of attributes are not drawn, only the attributes of the block reference.
        entities = [entity for entity in block if entity.dxftype() != "ATTDEF"]
        self._count(place, insert.mcount)
        for one in insert.multi_insert() if insert.mcount > 1 else [insert]:
            matrix = one.matrix44() @ place.matrix
            yield from self.drawn(entities, _Place(matrix, place.layer, place.depth))

    def _count(self, place: _Place, number: int = 1) -> None:
        self.count += number
        if self.count > _MOST or place.depth > _DEEPEST:
            raise damaged(self.where, "blocks are in each other too often or too deeply")

    def _is_hidden(self, entity: Any, layer: str) -> bool:
        if _said(entity, "invisible", 0):
            return True
        if layer not in self.document.layers:
            return False
        found = self.document.layers.get(layer)
        return bool(found.is_frozen() or (found.is_off() and entity.dxftype() != "INSERT"))


def _said(entity: Any, name: str, default: Any) -> Any:
    """Return an attribute; entities that ezdxf does not know have none."""
    return entity.dxf.get(name, default) if entity.dxf.is_supported(name) else default
