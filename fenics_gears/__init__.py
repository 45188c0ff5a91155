"""Spur gear pairs as flexible multi-body systems with frictional contact."""

__version__ = "0.1.0"
