"""Records read from files: frozen pydantic models that refuse unknown keys and carry their sources.
Validation reports every problem at once, with dotted keys and the nearest known key."""

from __future__ import annotations

import tomllib
import types
import typing
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from klingel.errors import InputError, Problem, nearest
from klingel.units import Unit

Status = Literal["repo", "memory", "derived", "design"]
"""Where a number comes from: read in a public file; recalled from the literature, unverified; computed; this
project's own choice."""


TAG = "kind:"
"""Beginning of the tag of a table that comes in several kinds; it is no key of a file."""


class Record(BaseModel):
    """Immutable table of a file; unknown keys are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Sourced(Record):
    """A table whose numbers have a source.

    source: names from the file's `[sources]`; status: of every number of the table except those in `estimated`,
    which gives another status for single keys; note: the reasoning, for choices of this project.
    """

    source: tuple[str, ...] = ()
    status: Status
    estimated: dict[str, Status] = {}
    note: str = ""


@dataclass(frozen=True)
class Parameter:
    """One number of a file: dotted key, value in `unit` (SI), status, names of its sources, note of its table."""

    key: str
    value: Any
    unit: str
    status: str
    source: tuple[str, ...]
    note: str


R = TypeVar("R", bound=BaseModel)


def validated(model: type[R], data: Mapping[str, Any], *, file: str | None = None) -> R:
    """`data` as a `model`; errors: InputError with every problem."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise InputError([_problem(item, model) for item in error.errors()], file=file) from None


def read_toml(path: str | Path) -> dict[str, Any]:
    """The tables of a TOML file; errors: InputError for a missing file, a folder or bad syntax."""
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InputError.single("", None, "no such file", remedy="check the path", file=str(path)) from None
    except (OSError, UnicodeDecodeError) as error:
        raise InputError.single("", None, f"cannot be read ({error})", file=str(path)) from None
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError.single("", None, f"is not TOML: {error}", remedy="mend that line", file=str(path)) from None


def parameters(record: Record) -> Iterator[Parameter]:
    """Every physical quantity of a record and of the records inside it, with its unit, status and sources."""
    yield from _walk(record, (), None, 0)


def _walk(record: Record, path: tuple[str, ...], table: Sourced | None, depth: int) -> Iterator[Parameter]:
    """`table`: the innermost sourced table around `record`; `depth`: length of that table's own path."""
    if isinstance(record, Sourced):
        table, depth = record, len(path)
    for name, field in type(record).model_fields.items():
        value = getattr(record, name)
        key = (*path, name)
        if isinstance(value, Record):
            yield from _walk(value, key, table, depth)
            continue
        unit = _unit(field.metadata, field.annotation)
        if unit is not None and value is not None and table is not None:
            status = _status(key[depth:], table)
            source = table.source if status == table.status else ()
            yield Parameter(".".join(key), value, unit, status, source, table.note)


def _status(key: tuple[str, ...], table: Sourced) -> Status:
    """Of `key` relative to `table`: the longest entry of `estimated` that it begins with, else the table's."""
    for end in range(len(key), 0, -1):
        status = table.estimated.get(".".join(key[:end]))
        if status is not None:
            return status
    return table.status


def _unit(metadata: Sequence[Any], annotation: Any) -> str | None:
    """Unit of a quantity, of an optional quantity or of the items of a tuple of quantities."""
    for meta in metadata:
        if isinstance(meta, Unit):
            return meta.name
    return _item_unit(annotation)


def _item_unit(annotation: Any) -> str | None:
    """Unit of an optional quantity or of the items of a tuple of quantities."""
    for argument in typing.get_args(annotation):
        for meta in getattr(argument, "__metadata__", ()):
            if isinstance(meta, Unit):
                return meta.name
    return None


def _problem(item: Any, model: type[BaseModel]) -> Problem:
    loc = tuple(part for part in item["loc"] if not str(part).startswith(TAG))
    key = ".".join(str(part) for part in loc)
    context = item.get("ctx", {})
    match item["type"]:
        case "extra_forbidden":
            parent = _model_at(tuple(item["loc"])[:-1], model)
            known = list(parent.model_fields) if parent else []
            return Problem(key, item["input"], "is not a known key", nearest(str(loc[-1]), known))
        case "missing":
            return Problem(key, None, "is missing", "add it")
        case "greater_than":
            return Problem(key, item["input"], "must be positive", "give a value above zero")
        case "greater_than_equal":
            return Problem(key, item["input"], "must not be negative", "give zero or more")
        case "union_tag_invalid":
            tags = str(context.get("expected_tags", "")).replace(TAG, "")
            return Problem(f"{key}.kind", context.get("tag", "").removeprefix(TAG), "is not known", f"use {tags}")
        case "literal_error":
            return Problem(key, item["input"], "is not known", f"use {context.get('expected', '')}")
        case _:
            message = str(item["msg"]).removeprefix("Value error, ")
            return Problem(key, None if _is_table(item["input"]) else item["input"], message, context.get("remedy", ""))


def _is_table(value: object) -> bool:
    return isinstance(value, (Mapping, BaseModel))


def _model_at(loc: Sequence[int | str], model: type[BaseModel]) -> type[BaseModel] | None:
    """The model that `loc` leads to, None where that is no model."""
    candidates: list[Any] = [model]
    for part in loc:
        if str(part).startswith(TAG):
            candidates = [c for c in candidates if _kind(c) == str(part).removeprefix(TAG)]
            continue
        inside = [c for c in candidates if isinstance(c, type) and issubclass(c, BaseModel)]
        if inside:
            field = inside[0].model_fields.get(str(part))
            candidates = _members(field.annotation) if field else []
    return next((c for c in candidates if isinstance(c, type) and issubclass(c, BaseModel)), None)


def _kind(candidate: Any) -> Any:
    """The kind that a record is of by default, None for one that has no kinds."""
    field = candidate.model_fields.get("kind") if hasattr(candidate, "model_fields") else None
    return field.default if field else None


def _members(annotation: Any) -> list[Any]:
    origin = typing.get_origin(annotation)
    if origin in (typing.Union, types.UnionType, tuple, list):
        return [m for a in typing.get_args(annotation) for m in _members(a)]
    if origin is typing.Annotated:
        return _members(typing.get_args(annotation)[0])
    return [annotation]
