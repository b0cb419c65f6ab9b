"""Studies: many runs, one folder of tables, figures and a report.
Each study is one module with a function `run`."""
