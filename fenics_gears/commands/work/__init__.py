"""What the commands do, a module for each; their arguments are in the folder above, which loads none of it."""
