"""The settings of a run that names a target: chosen by trial runs before it starts."""
