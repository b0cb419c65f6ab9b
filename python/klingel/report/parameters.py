"""Parameters as rows of a table: the vehicle's with their sources, the strategies' with their reasons.
The reasons are those of the strategies' own documentation, so there is one place to keep them."""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from klingel.vehicle import Vehicle


def vehicle_rows(vehicle: Vehicle) -> list[dict[str, str]]:
    """Every number of a vehicle with unit, status, sources and note.

    Args:
        vehicle: of the library or of a file.

    Returns:
        Rows with `key`, `value`, `unit`, `status`, `source`, `note`.

    Example:
        >>> from klingel import library
        >>> row = vehicle_rows(library.vehicle("manchester_coach"))[0]
        >>> row["key"], row["value"], row["unit"], row["status"]
        ('geometry.half_bogie_spacing', '9.5', 'm', 'repo')
    """
    return [
        {
            "key": parameter.key,
            "value": number(parameter.value),
            "unit": "" if parameter.unit == "1" else parameter.unit,
            "status": parameter.status,
            "source": ", ".join(parameter.source),
            "note": parameter.note,
        }
        for parameter in vehicle.parameters()
    ]


def strategy_rows(strategy: Any) -> list[dict[str, str]]:
    """Every setting of a strategy with its meaning and reason.

    Args:
        strategy: a dataclass whose docstring lists its fields as `name: meaning`, one or more names an entry.

    Returns:
        Rows with `key`, `value`, `meaning`; settings of settings have dotted keys.

    Example:
        >>> from klingel import control
        >>> [row["value"] for row in strategy_rows(control.IRWLike()) if row["key"] == "curvature"]
        ['gyro']
    """
    return list(_rows(strategy, ""))


def _rows(holder: Any, prefix: str) -> Iterator[dict[str, str]]:
    names = [field.name for field in dataclasses.fields(holder)]
    meanings = documented_fields(inspect.getdoc(type(holder)) or "", names)
    for field in dataclasses.fields(holder):
        value = getattr(holder, field.name)
        if dataclasses.is_dataclass(value):
            yield from _rows(value, f"{prefix}{field.name}.")
        else:
            key = f"{prefix}{field.name}"
            yield {"key": key, "value": number(value), "meaning": meanings.get(field.name, "")}


def documented_fields(docstring: str, names: Iterable[str]) -> dict[str, str]:
    """Meaning of every field that a docstring lists.

    Args:
        docstring: without its indentation; an entry is `names: meaning` and ends at the next one or at a blank line.
        names: of the fields.

    Returns:
        Name to meaning, on one line.

    Example:
        >>> documented_fields("A thing.\\n\\na, b: two\\n    numbers. c: one.\\n\\nEnd.", ["a", "b", "c"])
        {'a': 'two numbers', 'b': 'two numbers', 'c': 'one'}
    """
    one = "|".join(map(re.escape, names))
    entry = re.compile(rf"(?:^|\s)((?:{one})(?:, (?:{one}))*): ")
    meanings: dict[str, str] = {}
    for paragraph in docstring.split("\n\n"):
        text = " ".join(paragraph.split())
        found = list(entry.finditer(text))
        starts = [*(match.start() for match in found), len(text)]
        for match, end in zip(found, starts[1:], strict=True):
            meanings |= dict.fromkeys(match.group(1).split(", "), text[match.end() : end].strip().rstrip(".;"))
    return meanings


def number(value: Any) -> str:
    """A value as text: six digits, lists with commas.

    Example:
        >>> number(3.1391e7), number((0.0, 0.025)), number(None)
        ('3.1391e+07', '0, 0.025', '–')
    """
    if value is None:
        return "–"
    if isinstance(value, (tuple, list)):
        return ", ".join(number(item) for item in value)
    return f"{value:.6g}" if isinstance(value, (int, float)) else str(value)
