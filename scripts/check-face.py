#!/usr/bin/env python3
"""check-face.py [ROOT]: every public declaration of the library's headers has its manual. A doc comment stands at each
class, function, constant, enumerator, alias, macro and data member (one for all that a line declares); and each function
says its errors, its cost, which threads may call it and what it allocates: itself, or by a sentence "Unless a function
says otherwise: Errors: …" of its class or its file. Copying, moving, destroying and comparing need no words. And nothing
public shows a type of the library's inside, which stands in a namespace below sightline."""
import json
import pathlib
import re
import subprocess
import sys

LABELS = ("Errors", "Cost", "Threads", "Allocates")
SAID = re.compile(r"\b((?:%s)(?:, (?:%s))*):" % ("|".join(LABELS), "|".join(LABELS)))
FUNCTIONS = ("FunctionDecl", "CXXMethodDecl", "CXXConstructorDecl", "CXXConversionDecl")
RECORDS = ("CXXRecordDecl", "RecordDecl")
TEMPLATES = ("ClassTemplateDecl", "FunctionTemplateDecl")
OTHERS = ("FieldDecl", "VarDecl", "EnumDecl", "EnumConstantDecl", "TypeAliasDecl", "TypedefDecl")


def labels(text):
    return {label for match in SAID.finditer(text) for label in match.group(1).split(", ")}


def defaults(text):
    """What a comment says for all functions below it."""
    _, found, rest = text.partition("Unless a function")
    return labels(rest) if found else set()


def comment_of(node):
    """The text of a declaration's doc comment, or nothing."""
    def texts(part):
        yield part.get("text", "")
        for inner in part.get("inner", ()):
            yield from texts(inner)
    return "".join(text for part in node.get("inner", ()) if part["kind"] == "FullComment" for text in texts(part)).strip()


def children(node):
    return node.get("inner", ())


def parse(root, language, includes):
    """The declarations of a file that includes all of them, as clang has them, each with its file and line."""
    call = ["clang++-19" if language == "c++" else "clang-19", "-x", language, "-fsyntax-only", "-I", str(root / "include"),
            "-std=" + ("c++20" if language == "c++" else "c99"), "-Xclang", "-ast-dump=json"]
    # All of C++'s standard library would be a gigabyte; C's is nothing.
    call += ["-Xclang", "-ast-dump-filter=sightline"] if language == "c++" else []
    done = subprocess.run([*call, "-"], input="".join(f"#include <{name}>\n" for name in includes), capture_output=True,
                          text=True)
    if done.returncode != 0:
        sys.exit(f"the headers do not compile:\n{done.stderr}")
    decoder, at, nodes, text = json.JSONDecoder(), 0, [], done.stdout.strip()
    while at < len(text):
        node, at = decoder.raw_decode(text, at)
        nodes.append(node)
        at += len(text[at:]) - len(text[at:].lstrip())
    place(nodes)
    return nodes


def place(nodes):
    """Gives each node the file and line it stands at: clang writes them only where they change."""
    now = {"file": "", "line": 0}

    def locate(location):
        for part in (location, location.get("spellingLoc", {}), location.get("expansionLoc", {})):
            now.update({key: part[key] for key in ("file", "line") if key in part})

    def walk(node):
        locate(node.get("loc", {}))
        node["at"] = dict(now)
        for end in ("begin", "end"):
            locate(node.get("range", {}).get(end, {}))
        for inner in children(node):
            walk(inner)
    for node in nodes:
        walk(node)


class Face:
    """What the headers declare, and what is wrong with it."""

    def __init__(self, root):
        self.root, self.wrong, self.count = root, [], 0
        self.inside = {folder.name for folder in (root / "library").glob("*/")}
        self.heads, self.lines = {}, {}

    def complain(self, node, name, what):
        file = pathlib.Path(node["at"]["file"]).resolve().relative_to(self.root)
        self.wrong.append(f"{file}:{node['at']['line']}: {name} {what}")

    def is_ours(self, node):
        """Whether a public header of the library's declares it."""
        folder = pathlib.Path(node["at"]["file"]).resolve().parent
        return folder in (self.root / "include/sightline", self.root / "include/sightline/c")

    def head_of(self, node):
        """What the file's first comment says for all functions; C's headers share that of <sightline/sightline.h>."""
        file = pathlib.Path(node["at"]["file"]).resolve()
        if file.suffix == ".h":
            file = self.root / "include/sightline/sightline.h"
        if file not in self.heads:
            head = re.split(r"^#", file.read_text(encoding="utf-8"), maxsplit=1, flags=re.M)[0]
            self.heads[file] = defaults(re.sub(r"\s+(?:\*|//)?\s*", " ", head))
        return self.heads[file]

    def look_at(self, node, above="", said=frozenset(), outer=None):
        """A declaration and, where it is a namespace or a type, what it holds. `above` is the name it stands in, `said`
        what that says for all its functions, `outer` the template that it is the pattern of."""
        kind, name = node["kind"], node.get("name", "")
        if node.get("isImplicit"):
            return
        if kind in ("TranslationUnitDecl", "LinkageSpecDecl") or (kind == "NamespaceDecl" and name == "sightline"):
            for inner in children(node):
                self.look_at(inner)
        elif kind in TEMPLATES and self.is_ours(node):
            pattern = next(inner for inner in children(node) if inner["kind"] in RECORDS + FUNCTIONS)
            self.look_at(pattern, above, said, node)
        elif kind in RECORDS + FUNCTIONS + OTHERS and self.is_ours(node):
            self.judge(node, f"{above}{name}" or "an enumeration", said, comment_of(outer or node) or comment_of(node))

    def judge(self, node, name, said, comment):
        kind = node["kind"]
        if is_conventional(node) or (kind in RECORDS and not node.get("completeDefinition")):
            return
        self.count += 1
        shared = self.lines.setdefault((node["at"]["file"], node["at"]["line"]), comment)
        unnamed = kind == "EnumDecl" and "name" not in node
        if not comment and not (shared and kind in ("FieldDecl", "EnumConstantDecl")) and not unnamed:
            self.complain(node, name, "has no doc comment")
        self.look_for_inside(node, name)
        if kind in FUNCTIONS:
            missing = [label for label in LABELS if label not in labels(comment) | said | self.head_of(node)]
            if missing and not is_destroy(name):
                self.complain(node, name, f"does not say: {', '.join(missing)}")
        elif kind in RECORDS + ("EnumDecl",):
            self.members(node, name, defaults(comment) | said)

    def members(self, node, name, said):
        public = node.get("tagUsed") != "class"
        for inner in children(node):
            if inner["kind"] == "AccessSpecDecl":
                public = inner["access"] == "public"
            elif public and inner["kind"] != "FriendDecl":
                self.look_at(inner, "" if node["kind"] == "EnumDecl" and node.get("scopedEnumTag") is None
                             else f"{name}::", said)

    def look_for_inside(self, node, name):
        """Types that are written, or stand for one, in a namespace below sightline."""
        parts = [node] + [inner for inner in children(node) if inner["kind"] == "ParmVarDecl"]
        shown = " ".join(part.get("type", {}).get(key, "") for part in parts for key in ("qualType", "desugaredQualType"))
        below = "|".join(sorted(self.inside))
        found = re.search(rf"\bsightline::([a-z]\w*)::\w+|(?<![\w:])({below})::\w+", shown)
        if found and node["kind"] != "EnumConstantDecl":
            self.complain(node, name, f"shows {found.group()}, which is the library's own")

    def macros(self):
        """C's constants, which clang has not."""
        for file in sorted((self.root / "include/sightline/c").glob("*.h")):
            lines = file.read_text(encoding="utf-8").splitlines()
            for at, line in enumerate(lines):
                macro = re.match(r"#define (SIGHTLINE_(?!API\b)\w+) \S", line)
                if macro and not re.search(r"\*/$|^#define SIGHTLINE_VERSION", lines[at - 1]):
                    self.wrong.append(f"{file.relative_to(self.root)}:{at + 1}: {macro.group(1)} has no doc comment")
                self.count += bool(macro)


def is_destroy(name):
    return name.endswith("_destroy")


def is_conventional(node):
    """What every type of its kind has: nobody asks what it does."""
    name, written = node.get("name", ""), node.get("type", {}).get("qualType", "")
    if name in ("operator==", "operator=") or is_destroy(name) or node.get("explicitlyDefaulted"):
        return True
    own = re.escape(name)
    return node["kind"] == "CXXConstructorDecl" and re.match(rf"void \((?:const )?{own}(?:<\w+>)? &&?\)", written)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
    face = Face(root)
    headers = [f"sightline/{file.name}" for file in sorted((root / "include/sightline").glob("*.hpp"))]
    for language, includes in (("c++", headers), ("c", ["sightline/sightline.h"])):
        for node in parse(root, language, includes):
            face.look_at(node)
    face.macros()
    print("\n".join(sorted(set(face.wrong))) or f"all {face.count} public declarations of the library have their manual")
    return bool(face.wrong)


if __name__ == "__main__":
    sys.exit(main())
