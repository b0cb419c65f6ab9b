"""Creep forces against the full theory."""
