"""Equivalent conicity of EN 15302."""
