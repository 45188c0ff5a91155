"""Runs: one from a scene to its result, many from their keys to what is kept of them. Whatever asks for runs, a study
or a search, starts none itself."""
