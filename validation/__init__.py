"""Validation: Klingel against references that nobody here wrote, each with a named tolerance and its reason.
`python -m validation` runs every case and writes docs/validation.md with its pictures."""
