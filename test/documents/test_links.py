"""What README, CONTRIBUTING and docs refer to is there: the files and headings of their links, and the paths that they name."""
import re
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\(([^)\s]+)\)")
PATH = re.compile(r"(?<![\w/.$~:-])(?:scripts|launch|config|rviz|docs|examples)/[\w./*-]*\w")
CODE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)


def documents():
    return [REPOSITORY / "README.md", REPOSITORY / "CONTRIBUTING.md", *sorted((REPOSITORY / "docs").glob("*.md"))]


def anchors(document):
    """Of its headings, as they are made of Markdown: without marks, in lower case, with - for each blank."""
    headings = re.findall(r"^#+ (.*)$", CODE.sub("", document.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}


class LinksTest(unittest.TestCase):
    def test_every_link_leads_to_a_file_and_a_heading(self):
        count = 0
        for document in documents():
            for link in LINK.findall(CODE.sub("", document.read_text(encoding="utf-8"))):
                if "://" in link:
                    continue
                count += 1
                with self.subTest(document=document.name, link=link):
                    path, _, anchor = link.partition("#")
                    target = (document.parent / path).resolve() if path else document
                    self.assertTrue(target.exists())
                    if anchor:
                        self.assertIn(anchor, anchors(target))
        self.assertGreater(count, 50)

    def test_every_path_that_is_named_is_there(self):
        count = 0
        for document in documents():
            for path in PATH.findall(document.read_text(encoding="utf-8")):
                count += 1
                with self.subTest(document=document.name, path=path):
                    self.assertTrue(list(REPOSITORY.glob(path)))
        self.assertGreater(count, 50)


if __name__ == "__main__":
    unittest.main()
