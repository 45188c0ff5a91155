"""What accuracy costs in time (`gears accuracy`): the error of each setting alone, of whole settings and of cheaper
models."""
