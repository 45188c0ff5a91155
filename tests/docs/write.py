"""Write the documentation's generated pages and tables anew: `python -m tests.docs.write`."""

from pathlib import Path

from tests.benchmarks.marked_section import markers, write_section
from tests.docs import commands_page, kept_numbers, result_page, scene_page

DOCS = Path(__file__).parents[2] / "docs"
PAGES = {"scene.md": scene_page.page, "result.md": result_page.page, "commands.md": commands_page.page}

if __name__ == "__main__":
    for name, page in PAGES.items():
        (DOCS / name).write_text(page(), encoding="utf-8")
        print(DOCS / name)
    for (page_name, section), words in kept_numbers.SECTIONS.items():
        write_section(DOCS / "evidence" / page_name, *markers(section), words())
