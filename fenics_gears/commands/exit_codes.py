"""Exit codes that no error carries itself (``errors`` has those)."""

INTERRUPTED = 130
