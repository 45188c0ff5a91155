"""The commands of ``gears``: each module adds one to the parser and carries it out. Nothing heavy is imported before it
is needed."""
