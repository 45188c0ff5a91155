"""Many runs: from a scene's key to what is kept of its result, in memory, in a folder or as lines, in one process or by
all ranks of a job. Whatever asks for runs, a study or a search, starts none itself."""
