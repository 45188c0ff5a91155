"""Gear data from REXS files (www.rexs.info), the open format of gear programs: read, and written out as a scene.

``read`` reads the three forms of the file (XML, JSON, ZIP) into a ``model`` of components and relations; ``stage`` chooses the pair;
``gears``, ``flanks``, ``loads`` look its values up (``reading``, with units by ``values``); ``scene_text`` writes them as TOML.
"""
