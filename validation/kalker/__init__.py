"""Kalker's coefficients."""
