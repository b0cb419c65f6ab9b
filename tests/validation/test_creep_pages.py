"""What docs/theory/creep_table.md says about the laws and the table is what the cases measure."""

from collections.abc import Callable

import pytest
from validation.creep_laws import summary


@pytest.mark.parametrize("made", [summary.laws, summary.table])
def test_page_has_the_errors(made: Callable[[], str]) -> None:
    text = made()
    assert text in summary.PAGE.read_text(encoding="utf-8"), (
        f"run python -m validation.creep_laws.summary; the page should have\n{text}"
    )
