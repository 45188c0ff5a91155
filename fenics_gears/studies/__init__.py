"""Parameter studies: a base scene, the fields to vary, and one run for each combination, alone or under MPI.

`study_file` reads and validates; `run_study` runs, `combine` joins the runs into one dataset.
"""
