"""Exit codes that no error carries itself (``errors`` has those)."""

INTERRUPTED = 130
# 128 + SIGPIPE, as a shell has it.
NOBODY_READS = 141
