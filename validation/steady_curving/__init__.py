"""Steady curving against runs that have settled."""
