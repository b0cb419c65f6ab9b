"""Every validation case reaches every figure that was asked of it."""

import pytest
from validation.page import CASES, case, table


@pytest.mark.parametrize("name", CASES)
def test_case_reaches_its_figures(name: str) -> None:
    missed = [row for row in case(name).run() if not row.passed]
    assert not missed, table(missed)
