// The command line: a thin face on the workbench. Results go to stdout, complaints to stderr.
#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <span>
#include <sstream>
#include <system_error>
#include <thread>

#include <sightline/version.hpp>
#include <sightline/workbench/error.hpp>

#include "command.hpp"
#include "workbench/io/unfinished.hpp"

namespace sightline::app {

namespace {

std::string list_of(const std::vector<const CLI::App*>& commands) {
  std::string names;
  for (const CLI::App* command : commands) names += (names.empty() ? "" : ", ") + command->get_name();
  return names;
}

// CLI11's own words, but where they hide what was typed: a command that there is not, or an option before
// any.
std::string complaint(const CLI::App& app, const CLI::ParseError& error, std::span<char*> words) {
  const CLI::App* at = &app;
  std::string call = app.get_name();
  for (const std::string word : words) {
    const auto commands = at->get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty()) break;
    if (word.starts_with('-')) return "'" + word + "': no such option here, see " + call + " --help";
    const auto found = std::ranges::find(commands, word, [](const CLI::App* of) { return of->get_name(); });
    if (found == commands.end())
      return "'" + word + "': no such command, expected one of " + list_of(commands);
    at = *found, call += ' ' + word;
  }
  return std::string(error.what()) + "; see " + call + " --help";
}

void expect_written() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw std::system_error(errno, std::generic_category(), "standard output");
}

// Signals that end the program are blocked everywhere but in one thread that waits for them: it may do more
// than a handler may. Those that the caller has it ignore, as nohup does, would come too once they are
// blocked.
void end_tidily_on_signals() {
  sigset_t ends;
  sigemptyset(&ends);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaddset(&ends, signal);
  }
  pthread_sigmask(SIG_BLOCK, &ends, nullptr);
  std::thread([ends] {
    int signal = 0;
    sigwait(&ends, &signal);
    io::remove_unfinished();
    std::signal(signal, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &ends, nullptr);
    raise(signal);
  }).detach();
}

int run(int argc, char** argv) {
  end_tidily_on_signals();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may grow no larger is an error like a full disk
  std::signal(SIGPIPE, SIG_IGN);  // and so is a pipe that nobody reads
  CLI::App app{"Sightline decides what not to draw: visibility culling, measured and proven.", "sightline"};
  app.set_version_flag("--version", std::string(kVersion));
  app.require_subcommand(1);
  int exit = Exit::done;
  add_methods(app, exit);
  add_compare(app, exit);
  add_verify(app, exit);
  add_reproduce(app, exit);
  add_bake(app, exit);
  add_query(app, exit);
  add_occluders(app, exit);
  add_casters(app, exit);
  add_generate(app, exit);
  add_info(app, exit);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      throw Error(complaint(app, error, std::span(argv, argv + argc).subspan(argc > 0)));
    // Help or version. Not to std::cout, which keeps from us why it cannot be written to.
    std::ostringstream text;
    app.exit(error, text, text);
    fmt::print("{}", text.str());
  }
  expect_written();
  return exit;
}

}  // namespace
}  // namespace sightline::app

int main(int argc, char** argv) {
  try {
    return sightline::app::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "sightline: out of memory: the scene or the image is too large for this machine\n");
  } catch (const std::system_error& error) {
    // Which is what is wrong where a print fails, but not with what is printed.
    const bool printing = std::ferror(stdout) != 0;
    // A reader that has seen enough is no mistake: end as programs do then, now that all is tidied up.
    if (printing && error.code() == std::errc::broken_pipe)
      std::signal(SIGPIPE, SIG_DFL), std::raise(SIGPIPE);
    std::fprintf(
        stderr, "sightline: %s\n",
        printing ? "standard output: cannot be written to" : sightline::printable(error.what()).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sightline: %s\n", sightline::printable(error.what()).c_str());
  }
  return sightline::app::Exit::wrong_call;
}
