"""What the program offers beyond its core: each folder is an extension with its command, its physics, its pictures."""
