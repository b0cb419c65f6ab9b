"""Vehicle files that are made of another one: `base` names the file, whole tables replace its tables.
So a variant states only what differs, and why."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from klingel.errors import InputError, nearest

Tables = Mapping[str, Any]


def resolved(tables: Tables, read: Callable[[str], Tables], *, file: str | None = None) -> dict[str, Any]:
    """The tables of a file with those of its `base` under them; `read` gives the tables of a file beside it.

    `without` lists tables of the base that the variant does not have; `[sources]` are added to those of the base.
    Errors: InputError for a base that has a base itself, and for tables to leave out that it does not have.

    >>> coach = {"name": "coach", "sources": {}, "yaw_damper": {"damping": "200 kN s/m"}}
    >>> resolved({"base": "coach.toml", "name": "calm", "without": ["yaw_damper"]}, lambda file: coach)
    {'name': 'calm', 'sources': {}}
    """
    if "base" not in tables:
        return dict(tables)
    own = {key: value for key, value in tables.items() if key not in ("base", "without")}
    base = read(tables["base"])
    if "base" in base:
        remedy = f"name {base['base']} in its place, and give all tables that differ"
        raise InputError.single("base", tables["base"], "has a base itself", remedy=remedy, file=file)
    without = tables.get("without", [])
    for key in without:
        if key not in base:
            message, remedy = f"is not in {tables['base']}", nearest(key, list(base))
            raise InputError.single("without", key, message, remedy=remedy, file=file)
    sources = {**base.get("sources", {}), **own.get("sources", {})}
    return {key: value for key, value in base.items() if key not in without} | own | {"sources": sources}
