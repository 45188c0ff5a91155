"""What the program offers beside its core: each folder is an extension with its command, its physics, its pictures."""
