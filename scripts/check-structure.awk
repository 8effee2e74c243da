# Judges the includes that check-structure.sh lists, by the tables that it lists before them.

function complain(sentence) {
  print sentence
  failed = 1
}

# Whether `folder` stands on `on`, directly or through others; every folder is reached once.
function stands_on(folder, on, seen,    part, count, i) {
  seen[folder] = 1
  count = split(below[folder], part, " ")
  for (i = 1; i <= count; ++i) {
    if (part[i] == on) return 1
    if (!(part[i] in seen) && stands_on(part[i], on, seen)) return 1
  }
  return 0
}

function reaches(folder, on,    seen) {
  if (!((folder, on) in known)) known[folder, on] = stands_on(folder, on, seen)
  return known[folder, on]
}

# The folder that a path in the tree, or a target of an include, belongs to; "" for others' headers.
function folder_of(path,    part, header) {
  split(path, part, "/")
  if (path ~ /^examples\/method\//) return "examples/method"
  if (path ~ /^examples\//) return "examples"
  if (path ~ /^web\/paper\//) return "web/paper"
  if (path ~ /^web\/scenes\//) return "web/scenes"
  if (path ~ /^web\//) return "web"
  if (path ~ /^(library|workbench|apps|bindings)\//) return part[1] "/" part[2]
  header = path
  if (sub(/^(include\/)?sightline\//, "", header)) return header in owner ? owner[header] : "unknown"
  return ""
}

function is_shared(file, target,    part, count, i) {
  count = split(users[target], part, " ")
  for (i = 1; i <= count; ++i) {
    if (index(file, part[i]) == 1) {
      needed[target, part[i]] = 1
      return 1
    }
  }
  return 0
}

function is_package(target,    name) {
  for (name in packages) if (index(target, name) == 1) return 1
  return 0
}

function judge(file, line, target,    from, to, at) {
  at = file ":" line ": "
  from = folder_of(file)
  to = folder_of(target)
  if (target ~ /\.\./) return complain(at "name " target " from the root of the tree")
  if (from == "unknown" || to == "unknown")
    return complain(at "no folder owns the public header " (to == "unknown" ? target : file))
  if (file ~ /^include\// && target ~ /^(library|workbench|apps|bindings)\//)
    return complain(at "a public header must not include " target ", which is not installed")
  if (to == "") {
    # The standard library's headers have neither folder nor ending; <tbb/…> is for who asks for it.
    if (from ~ /^library\// && target ~ /[\/.]/ && target !~ /^std(int|def)\.h$/ && !is_package(target) &&
        !(file ~ /\/tbb\.hpp$/ && target ~ /^tbb\//))
      complain(at from " must not include " target)
    return
  }
  if (from == to || reaches(from, to)) return
  if (from !~ /^library\// && to ~ /^(library\/|face$)/ && target ~ /^sightline\//) return
  if (is_shared(file, target)) return
  complain(at from " must not include " target (target ~ /^sightline\// ? ", which is " to "'s" : ""))
}

/^\[/ { section = substr($0, 2, length($0) - 2); next }
NF == 0 { next }
{ folder = substr($1, 1, length($1) - 1) }  # of the tables' lines, which are KEY: VALUE …
section == "arrows" {
  below[folder] = ""
  for (i = 2; i <= NF; ++i) below[folder] = below[folder] " " $i
}
section == "owners" { for (i = 2; i <= NF; ++i) owner[$i] = folder }
section == "shared" { for (i = 2; i <= NF; ++i) users[folder] = users[folder] " " $i }
section == "packages" { for (i = 1; i <= NF; ++i) packages[$i] = 1 }
section == "folders" && !($1 in below) {
  complain($1 ": the structure knows no such folder; add it to scripts/check-structure.sh and docs/architecture.md")
}
section == "includes" {
  file = substr($0, 1, index($0, ":") - 1)
  rest = substr($0, length(file) + 2)
  judge(file, substr(rest, 1, index(rest, ":") - 1), substr(rest, index(rest, ":") + 1))
}

END {
  for (folder in below) if (reaches(folder, folder)) complain(folder ": stands on itself, through others")
  if (whole == "yes") {
    for (header in users) {
      count = split(users[header], part, " ")
      for (i = 1; i <= count; ++i)
        if (!((header, part[i]) in needed)) complain("scripts/check-structure.sh: " part[i] " needs no " header)
    }
  }
  if (!failed) print "the arrows hold"
  exit failed
}
