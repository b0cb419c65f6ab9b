"""Errors of Klingel: a small tree, each message with what, where, which value and what to do.
Bad input is reported whole: an InputError carries every problem found, not the first."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace


class KlingelError(Exception):
    """Anything Klingel refuses or fails to do; catch this to catch all."""


class StaleExtensionWarning(UserWarning):
    """The compiled core was built from other sources than those of the checkout."""


@dataclass(frozen=True)
class Problem:
    """One thing wrong with an input.

    key: dotted place inside the input, empty for the input as a whole; value: as given; message: what is wrong;
    remedy: what to do.
    """

    key: str
    value: object
    message: str
    remedy: str = ""

    def __str__(self) -> str:
        place = self.key if self.value is None else f"{self.key} = {_short(self.value)}"
        text = f"{place}: {self.message}" if place else self.message
        return f"{text}; {self.remedy}" if self.remedy else text


class InputError(KlingelError, ValueError):
    """Bad input: which file, key and value, and the remedy; all problems at once.

    >>> raise InputError.single("body.mass", -3.0, "must be positive [kg]", remedy="give a mass", file="coach.toml")
    Traceback (most recent call last):
    ...
    klingel.errors.InputError: coach.toml: body.mass = -3.0: must be positive [kg]; give a mass
    """

    def __init__(self, problems: Iterable[Problem], *, file: str | None = None) -> None:
        self.problems: tuple[Problem, ...] = tuple(problems)
        self.file = file
        super().__init__(self._text())

    @classmethod
    def single(cls, key: str, value: object, message: str, *, remedy: str = "", file: str | None = None) -> InputError:
        """An InputError with one problem."""
        return cls([Problem(key, value, message, remedy)], file=file)

    def within(self, key: str) -> InputError:
        """The same problems, their keys said to be inside `key`."""
        return InputError((replace(p, key=f"{key}.{p.key}" if p.key else key) for p in self.problems), file=self.file)

    def in_file(self, file: str) -> InputError:
        """The same problems, said to be in `file`."""
        return InputError(self.problems, file=file)

    def _text(self) -> str:
        head = f"{self.file}: " if self.file else ""
        if len(self.problems) == 1:
            return f"{head}{self.problems[0]}"
        lines = "\n".join(f"  {problem}" for problem in self.problems)
        return f"{head}{len(self.problems)} problems\n{lines}"


class SimulationError(KlingelError):
    """A run that could not be made or, with `strict=True`, did not complete; the message has time and place."""


class RunCancelledError(SimulationError):
    """A run was ended through its progress object."""


class CoreMissingError(KlingelError):
    """The compiled core is not installed."""


def nearest(word: object, known: Sequence[str]) -> str:
    """Remedy for an unknown word: the nearest known one, or all of them; all of them for what is no word.

    >>> nearest("mas", ["mass", "height"])
    "did you mean 'mass'?"
    >>> nearest("qqq", ["mass", "height"])
    'known: height, mass'
    """
    match = difflib.get_close_matches(word, known, n=1, cutoff=0.6) if isinstance(word, str) else []
    return f"did you mean {match[0]!r}?" if match else f"known: {', '.join(sorted(known))}"


def _short(value: object, limit: int = 60) -> str:
    text = repr(value)
    return text if len(text) <= limit else f"{text[: limit - 3]}..."
