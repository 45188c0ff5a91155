"""What makes a release: the wheel, the conda recipe, and the checks before both."""
