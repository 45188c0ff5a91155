"""Pages of HTML that need no network: their parts, and how they are written."""
