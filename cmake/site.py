"""Make an HTML site of the pages, with search, by mkdocs.

    python3 cmake/site.py FOLDER

The README is the first page, and its table "Where to read on" is the navigation. What pages link to
outside of docs/ (sources, scenes, folders) is copied to source/. The site is in FOLDER/html. Its
pages open without a server, and only the search needs one.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[1]
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s#]*)((?:#[^)\s]*)?\))")
CODE = re.compile(r"(^```.*?^```|`[^`\n]+`)", re.M | re.S)
PAGES = {"README.md": "index.md", "CHANGELOG.md": "changes.md", "python/README.md": "package.md"}


def place_of(path):
    """Return where a file or folder of the tree is in the site."""
    if path in PAGES:
        return PAGES[path]
    if path.startswith("docs/"):
        return path[len("docs/"):]
    if (TOP / path).is_dir():
        return f"source/{path}/index.md"
    return f"source/{path}" + ("" if pathlib.PurePath(path).suffix else ".txt")


class Site:
    """The pages, copied with their links changed."""

    def __init__(self, folder):
        self.folder, self.done = folder, set()

    def write(self, place, text):
        """Write a page."""
        target = self.folder / place
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)

    def add(self, path):
        """Add what a link names, once."""
        if path in self.done:
            return
        self.done.add(path)
        place, source = place_of(path), TOP / path
        if source.is_dir():
            names = sorted(p.name for p in source.iterdir() if p.is_file())
            listed = "".join(f"- [{name}]({name})\n" for name in names)
            self.write(place, self.changed(f"{path}/list", f"# {path}\n\n{listed}", place))
        elif path in PAGES or (path.startswith("docs/") and path.endswith(".md")):
            self.write(place, self.changed(path, source.read_text(), place))
        else:
            target = self.folder / place
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)

    def changed(self, path, text, place):
        """Return the text of a page with its links changed, but for code."""
        def change(match):
            before, target, after = match.groups()
            if not target or re.match(r"\w+:", target):
                return match.group()
            named = os.path.normpath(os.path.join(os.path.dirname(path), target))
            if not (TOP / named).exists():
                raise SystemExit(f"site: {path} links to {target}, which does not exist")
            self.add(named)
            return before + os.path.relpath(place_of(named), os.path.dirname(place)) + after
        parts = CODE.split(text)
        return "".join(part if i % 2 else LINK.sub(change, part) for i, part in enumerate(parts))


def navigation(text):
    """Return the rows of README's last table, each a title with its pages."""
    rows = re.findall(r"^\| (\[.*) \| (.*) \|$", text[text.index("## Where to read on"):], re.M)
    sections = [{"Start": "index.md"}]
    for links, title in rows:
        pages = [{name: place_of(os.path.normpath(target))}
                 for name, target in re.findall(r"\[([^\]]*)\]\(([^)]*)\)", links)
                 if target.endswith(".md")]
        sections.append({title[0].upper() + title[1:]: pages})
    return sections


def main(build):
    """Make the site in a folder."""
    build = pathlib.Path(build).resolve()
    pages = build / "pages"
    shutil.rmtree(pages, ignore_errors=True)
    site = Site(pages)
    site.add("README.md")
    for path in sorted((TOP / "docs").rglob("*.md")):
        site.add(str(path.relative_to(TOP)))
    options = {"site_name": "libdvi: discrete variational integrators", "site_url": "",
               "docs_dir": str(pages), "site_dir": str(build / "html"), "strict": True,
               "use_directory_urls": False, "plugins": ["search"],
               "theme": {"name": "readthedocs", "navigation_depth": 2},
               "nav": navigation((TOP / "README.md").read_text())}
    (build / "mkdocs.yml").write_text(json.dumps(options))  # YAML has JSON in it
    made = subprocess.run(["mkdocs", "build", "-q", "-f", str(build / "mkdocs.yml")])
    return made.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
