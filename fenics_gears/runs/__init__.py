"""Many runs: from a scene's key to what is kept of its result. Whatever asks for runs, a study or a search, starts none
itself."""
