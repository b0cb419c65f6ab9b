"""Studies: many runs, one folder of tables, figures and a report.
Each study is one module with a function `run`; `compare` puts any strategies beside each other."""

from klingel.study.compare import Comparison, compare

__all__ = ["Comparison", "compare"]
