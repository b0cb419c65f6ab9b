"""Command line of Klingel: `klingel study perez2004`, `run`, `modes`, `rootlocus`, `critical-speed`, `profile` ...
Bad input prints one message and exits with 2; Ctrl-C exits with 130; nothing half-written is left behind."""

from __future__ import annotations

import sys

from klingel.errors import InputError, KlingelError, RunCancelledError

CANCELLED = 130
"""Exit code of a command that Ctrl-C ended, as shells have it."""


def main() -> None:
    """Entry point of the `klingel` command."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: list[str]) -> int:
    """Run the command line; returns the exit code: 0, 1 for a failure, 2 for bad input, 130 for Ctrl-C."""
    try:
        from klingel.cli.app import app  # takes its time, in which Ctrl-C is heard as in a run

        app(arguments, prog_name="klingel", standalone_mode=True)
    except SystemExit as ended:  # typer turns Ctrl-C into a silent 130
        code = ended.code if isinstance(ended.code, int) else 0 if ended.code is None else 1
        return _cancelled() if code == CANCELLED else code
    except InputError as error:
        return _say("bad input", error, 2)
    except RunCancelledError as ended:
        return _cancelled(*getattr(ended, "__notes__", ()))
    except KeyboardInterrupt:
        return _cancelled()
    except KlingelError as error:
        return _say("failed", error, 1)
    return 0


def _cancelled(*kept: str) -> int:
    # Plain, as Ctrl-C may have come while the packages for colour were being imported.
    print(": ".join(("cancelled", *kept)), file=sys.stderr)
    return CANCELLED


def _say(head: str, text: object, code: int) -> int:
    from rich.console import Console
    from rich.text import Text

    console = Console(stderr=True, soft_wrap=True)
    console.print(Text.assemble((f"{head}: ", "bold red"), str(text)))
    return code
