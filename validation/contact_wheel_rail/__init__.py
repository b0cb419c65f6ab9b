"""Wheel on rail against CONTACT."""
