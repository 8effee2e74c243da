#!/usr/bin/env python3
"""check-docs.py [--links] [BUILD [ROOT]]: what the documents show is true. Links, and the paths that stand in
`backticks`, lead somewhere; and unless --links is said, all code is built with what BUILD installs, and run:

  ```cpp, ```c, ```python   a program, or the body of one's main(); it must end with 0
  ```cpp continues          goes on where the block of its language above it ends, and sees all that it sees
  ```cmake                  configures, with its targets as programs of their own
  ```js                     a module that Node can read; the npm package's own tests run such
  ```sh                     scripts, presets, targets, and the commands and options of `sightline` are there
  ```sh run                 is run besides, in the folder that the page's programs then run in
  ```                       anything else"""
import concurrent.futures
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.M | re.S)
LINK = re.compile(r"(!?)\[(?:[^][]|\[[^]]*\])*\]\(([^)\s]+)\)")
FOLDERS = "apps|benchmarks|bindings|cmake|docs|examples|fuzz|include|library|scripts|tests|web|workbench"
PATH = re.compile(rf"`((?:{FOLDERS})/[\w./-]*|[\w-]+\.(?:sh|md))`")
PROGRAMS = {"cpp": ["g++", "-std=c++20"], "c": ["cc", "-std=c99", "-pedantic"]}


class Page:
    """A document, and what is wrong with it."""

    def __init__(self, file, root):
        self.file, self.root, self.name = file, root, str(file.relative_to(root))
        self.text = file.read_text(encoding="utf-8")
        self.prose = FENCE.sub(lambda match: "\n" * match.group().count("\n"), self.text)
        self.wrong = []

    def complain(self, place, what):
        line = place if isinstance(place, int) else self.prose.count("\n", 0, place.start()) + 1
        self.wrong.append(f"{self.name}:{line}: {what}")

    def blocks(self):
        """(line, language, words after it, text) of each."""
        for match in FENCE.finditer(self.text):
            language, *words = match.group(1).split() or [""]
            yield self.text.count("\n", 0, match.start()) + 1, language, words, match.group(2)

    def anchors(self):
        """What a link may name after #, as the forges make it of headings."""
        headings = re.findall(r"^#+ (.*)$", self.prose, re.M)
        return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}

    def check_links(self, pages):
        for match in LINK.finditer(self.prose):
            target, _, anchor = match.group(2).partition("#")
            if re.match(r"\w+:", target):
                continue
            file = (self.file.parent / target).resolve() if target else self.file
            if not file.exists():
                self.complain(match, f"{match.group(2)} leads nowhere")
            elif anchor and file in pages and anchor not in pages[file].anchors():
                self.complain(match, f"{pages[file].name} has no heading #{anchor}")
        if self.file.name == "CHANGELOG.md":  # which tells of what is gone
            return
        for match in PATH.finditer(self.prose):
            places = (self.root / match.group(1), self.file.parent / match.group(1))
            if not any(place.exists() for place in places):
                self.complain(match, f"there is no {match.group(1)}")


class Checker:
    """Builds and runs what pages show, with an installed tree."""

    def __init__(self, root, build, scratch):
        self.root, self.build, self.scratch, self.prefix = root, build, scratch, scratch / "prefix"
        said = run(["cmake", "--install", build, "--prefix", self.prefix])
        if said.returncode != 0:
            sys.exit(f"{build} cannot be installed:\n{said.stdout}")
        self.environment = os.environ | {
            "LD_LIBRARY_PATH": str(self.prefix / "lib"), "PYTHONPATH": str(self.prefix / "lib/python3/dist-packages"),
            "PKG_CONFIG_PATH": str(next(self.prefix.rglob("sightline.pc")).parent),
            "PATH": f"{self.prefix / 'bin'}:{os.environ['PATH']}"}
        self.flags = self.call(["pkg-config", "--cflags", "--libs", "sightline"]).stdout.split()
        self.helps = {}
        self.targets = self.call(["ninja", "-C", build, "-t", "targets", "all"]).stdout

    def call(self, command, folder=None):
        return run(command, cwd=folder or self.scratch, env=self.environment)

    def check(self, page):
        """All blocks of a page; what is to be run first comes first."""
        folder = self.scratch / page.name.replace("/", "_")
        folder.mkdir()
        blocks = list(page.blocks())
        for line, language, words, text in blocks:
            if language == "sh":
                self.check_shell(page, line, text)
                if words == ["run"]:
                    self.expect(page, line, ["bash", "-euo", "pipefail", "-c", text], folder)
            elif language == "js":
                module = folder / f"{line}.mjs"
                module.write_text(text, encoding="utf-8")
                self.expect(page, line, ["node", "--check", module], folder)
            elif language not in ("cpp", "c", "python", "cmake", ""):
                page.complain(line, f"expected a block of cpp, c, python, cmake, js, sh or nothing, not '{language}'")
        for language in ("cpp", "c", "python"):
            for line, parts in programs(page, language, blocks):
                self.check_program(page, line, language, parts, folder)

    def expect(self, page, line, command, folder):
        done = self.call(command, folder)
        if done.returncode != 0:
            said = done.stdout.strip().replace(f"{folder}/", "")
            page.complain(line, f"exit {done.returncode}: {said[:1500]}")
        return done.returncode == 0

    def check_program(self, page, line, language, parts, folder):
        if language == "python":
            self.expect(page, line, ["/usr/bin/python3", "-c", "".join(parts)], folder)
            return
        source, program = folder / f"{line}.{language}", folder / str(line)
        source.write_text(whole(parts), encoding="utf-8")
        if self.expect(page, line, [*PROGRAMS[language], "-O1", "-Wall", "-Wextra", "-Werror", source, "-o", program,
                                    *self.flags, "-ltbb", "-pthread"], folder):
            self.expect(page, line, [program], folder)

    def check_shell(self, page, line, text):
        done = self.call(["bash", "-n", "-c", text])
        if done.returncode != 0:
            page.complain(line, done.stdout.strip())
        for number, command in enumerate(text.replace("\\\n", " ").splitlines(), line + 1):
            words = shlex.split(command.split(" #")[0].replace("…", ""), comments=True)
            for what in self.unknown(words):
                page.complain(number, what)

    def unknown(self, words):
        """What a command names and nobody has."""
        at = next((i for i, (before, word) in enumerate(zip([""] + words, words))
                   if re.fullmatch(r"\$?(.*/)?sightline", word) and not before.startswith("-")), None)
        if at is not None:
            yield from self.unknown_options(words[at + 1:])
        presets = (self.root / "CMakePresets.json").read_text(encoding="utf-8")
        options = "".join(file.read_text(encoding="utf-8") for file in
                          [self.root / "CMakeLists.txt", *(self.root / "cmake").glob("*.cmake")])
        for before, word in zip([""] + words, words):
            option = re.match(r"-D(SIGHTLINE_\w+)=", word)
            if option and option.group(1) not in options:
                yield f"there is no option {option.group(1)}"
            elif before == "--preset" and f'"name": "{word}"' not in presets:
                yield f"there is no preset {word}"
            elif before == "--target" and words[0] == "cmake" and not re.search(rf"^{re.escape(word)}: ", self.targets, re.M):
                yield f"there is no target {word}"
            elif re.match(rf"\./\w|(?:{FOLDERS})/", word) and not (self.root / word).exists():
                yield f"there is no {word}"

    def help_of(self, command):
        """What `sightline COMMAND --help` says; which lists the commands for an empty one."""
        if command not in self.helps:
            self.helps[command] = self.call(["sightline", *([command] if command else []), "--help"]).stdout
        return self.helps[command]

    def unknown_options(self, words):
        command = words[0] if words and not words[0].startswith("-") else ""
        if command and not re.search(rf"^  {re.escape(command)} ", self.help_of(""), re.M):
            yield f"sightline has no command {command}"
            return
        for word in words:
            option = re.match(r"--?[a-z][\w-]*", word)
            if option and not re.search(rf"(?<![\w-]){re.escape(option.group())}(?![\w-])", self.help_of(command)):
                yield f"sightline {command} has no option {option.group()}"

    def check_cmake(self, pages):
        """All blocks of all pages in one project, as configuring takes its time; their targets are programs."""
        folder, files, found = self.scratch / "cmake", [], {}
        folder.mkdir()
        (folder / "main.cpp").write_text("int main() {}\n", encoding="utf-8")
        for page in pages:
            for line, language, _, text in page.blocks():
                if language != "cmake":
                    continue
                number = len(files) + 1
                for target in sorted(set(re.findall(r"target_link_libraries\((\w+)", text))):
                    text = f"add_executable({target} main.cpp)\n" + text
                    text = re.sub(rf"\b{target}\b", f"{target}_{number}", text)
                name = f"{page.name.replace('/', '_')}-{line}.cmake"
                (folder / name).write_text(text, encoding="utf-8")
                files.append(name)
                found[name] = (page, line)
        (folder / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(docs LANGUAGES C CXX)\n" +
            "".join(f"include({name})\n" for name in files), encoding="utf-8")
        done = self.call(["cmake", "-G", "Ninja", "-S", folder, "-B", folder / "build",
                          f"-DCMAKE_PREFIX_PATH={self.prefix}"])
        if done.returncode != 0:
            page, line = next((found[name] for name in files if name in done.stdout), next(iter(found.values())))
            page.complain(line, f"does not configure: {done.stdout.strip()[-1500:]}")


def run(command, **options):
    return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          stdin=subprocess.DEVNULL, text=True, errors="replace", **options)


def programs(page, language, blocks):
    """(line, blocks) of each program of a language: a block, and those that continue it."""
    found = []
    for line, name, words, text in blocks:
        if name != language:
            continue
        if words == ["continues"] and found:
            found[-1][1].append(text)
        elif words:
            page.complain(line, f"'{' '.join(words)}' means nothing here")
        else:
            found.append((line, [text]))
    return found


def whole(parts):
    """One source of a program and what continues it: includes first, then main(), at whose end the others stand."""
    first, *others = parts
    if not re.search(r"\bmain\(", first):
        first, others = "int main() {\n}\n", parts
    includes = [line for part in others for line in re.findall(r"^#include .*\n", part, re.M)]
    body = "".join(re.sub(r"^#include .*\n", "", part, flags=re.M) for part in others)
    end = first.rindex("}")
    return "".join(includes) + first[:end] + body + first[end:]


def main():
    arguments = sys.argv[1:]
    links_only = arguments[:1] == ["--links"]
    arguments = arguments[links_only:]
    build = pathlib.Path(arguments[0] if arguments else ROOT / "build/release").resolve()
    root = pathlib.Path(arguments[1]).resolve() if len(arguments) > 1 else ROOT
    files = [*root.glob("*.md"), *root.glob("docs/**/*.md"), *root.glob("examples/**/*.md")]
    pages = {file.resolve(): Page(file.resolve(), root) for file in sorted(files)}
    for page in pages.values():
        page.check_links(pages)
    if not links_only:
        with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            checker = Checker(root, build, pathlib.Path(scratch))
            cmake = pool.submit(checker.check_cmake, pages.values())
            list(pool.map(checker.check, pages.values()))
            cmake.result()
    wrong = [line for page in pages.values() for line in page.wrong]
    blocks = sum(1 for page in pages.values() for _ in page.blocks())
    code = "" if links_only else f", {blocks} blocks of code hold"
    print("\n".join(wrong) or f"{len(pages)} pages: links lead somewhere{code}")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
