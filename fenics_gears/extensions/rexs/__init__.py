"""Gear data from REXS files (www.rexs.info), the open format of gear programs: read, and written out as a scene.

``read`` makes a ``model`` of components and relations of any form of the file (XML, JSON, ZIP). ``stage`` chooses the
pair; ``train`` follows the parts that turn and mesh around it. ``attributes`` is the table of what is looked up where;
``gears``, ``flanks``, ``lead`` and ``loads`` look it up, with units by ``values``. ``scene_text`` writes it as TOML.
"""
