"""Exit codes that no error carries itself (``errors`` has those)."""

# The run came to its end, but jammed or came apart: its numbers mean nothing.
NO_MEANING = 4
INTERRUPTED = 130
# 128 + SIGPIPE, as a shell has it.
NOBODY_READS = 141
