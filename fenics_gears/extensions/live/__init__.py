"""A gear pair that is changed in the browser: ``gears live``, and `live` in a notebook."""

__all__ = ["live"]


def __getattr__(name: str):
    """Load `live` when it is asked for: the command says what it takes without its libraries."""
    if name != "live":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from .notebook import live

    return live
