"""Strategies of a user's own Python file, named `path/file.py:Name` where a strategy of the library has its name.
The name is a class that is made with the parameters of its table, or an object that is ready."""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from pathlib import Path
from typing import Any

from klingel.errors import InputError, nearest

MARK = ".py:"
"""Between the path of a Python file and a name in it."""


def is_own(name: str) -> bool:
    """Whether a strategy's name is that of a user's file.

    >>> is_own("mine.py:Mine"), is_own("irw_like")
    (True, False)
    """
    return MARK in name


def own(name: str, folder: Path) -> Any:
    """The class or object of a Python file, which is run for it.

    name: `path.py:Name`, the path relative to `folder`.
    Errors: InputError for a missing file or name, one that fails when run, and what is no strategy.
    """
    place, _, wanted = name.partition(MARK)
    path = folder / f"{place}.py"
    if not path.is_file():
        raise InputError.single("control.strategy", name, "has no such file", remedy=f"check the path {path}")
    module = _run(path.resolve(), name)
    if not hasattr(module, wanted):
        known = [word for word, value in vars(module).items() if _of_the_file(word, value, module.__name__)]
        remedy = nearest(wanted, known) if known else "give it a class with a method lower(vehicle, track, speed)"
        raise InputError.single("control.strategy", name, "is not in that file", remedy=remedy)
    found = getattr(module, wanted)
    if isinstance(found, str) or not callable(getattr(found, "lower", None)):
        remedy = "give it a method lower(vehicle, track, speed)"
        raise InputError.single("control.strategy", name, "is no strategy", remedy=remedy)
    return found


def _of_the_file(word: str, value: object, module: str) -> bool:
    """Whether a name stands for a strategy that is written in the module: no text, no import, nothing private."""
    if word.startswith("_") or isinstance(value, str) or not callable(getattr(value, "lower", None)):
        return False
    return not isinstance(value, type) or value.__module__ == module


def made(kind: Any, name: str, values: dict[str, Any]) -> Any:
    """The strategy of a class with these values; a ready object takes none.

    Errors: InputError for values given to an object, and for a class that does not take them.
    """
    if not isinstance(kind, type):
        if values:
            remedy = "give them where it is made, or name its class"
            raise InputError.single(
                "control.strategy", name, f"is ready and takes no parameters ({', '.join(values)})", remedy=remedy
            )
        return kind
    try:
        return kind(**values)
    except InputError:
        raise
    except Exception as error:  # whatever a user's class does when it is made
        message = f"cannot be made: {type(error).__name__}: {error}"
        raise InputError.single("control.strategy", name, message, remedy="give every parameter a default") from error


def _run(path: Path, name: str) -> Any:
    """The module of a file, run as a script is: with its folder as the first to import from.

    Dataclasses look their module up while it runs, so it has a place among all others.
    """
    key = f"klingel_own_{path.stem}_{hashlib.sha256(str(path).encode()).hexdigest()[:12]}"
    spec = importlib.util.spec_from_file_location(key, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[key] = module
    sys.path.insert(0, str(path.parent))
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # whatever a user's file does when it is run
        del sys.modules[key]
        message = f"fails when run: {type(error).__name__}: {error}"
        raise InputError.single("control.strategy", name, message, remedy=f"mend {path}") from error
    finally:
        sys.path.remove(str(path.parent))
    return module
