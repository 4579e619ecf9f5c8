#pragma once

#include <exception>
#include <functional>
#include <iostream>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

namespace semantic_mht_slam {

/// Prints "name: line" on standard error for each line of `message`.
inline void printProblem(const char* name, const std::string& message) {
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);) std::cerr << name << ": " << line << '\n';
}

/// The same for what is no problem; nothing for an empty `notice`.
inline void printNotice(const char* name, const std::string& notice) {
  if (!notice.empty()) printProblem(name, notice);
}

/// Runs the body of a program and returns its exit code; any exception becomes "name: message", a line for each line of
/// the message, and exit code 1. So does standard output that cannot be written.
inline int runProgram(const char* name, const std::function<int()>& body) {
  try {
    const int code = body();
    std::cout.flush();
    if (std::cout) return code;
    printProblem(name, "cannot write to standard output");
  } catch (const std::bad_alloc&) {
    printProblem(name, "out of memory");
  } catch (const std::exception& error) {
    printProblem(name, error.what());
  }
  return 1;
}

/// Reads a command line that consists of options and puts the values into the variables that the options name, unless
/// the option "help" is among them. Throws boost::program_options::error for anything unknown, missing or repeated;
/// names of options must be complete. `positions` are the options whose names may be left out; an argument without its
/// option is an error else.
inline boost::program_options::variables_map parseCommandLine(
    const std::vector<std::string>& arguments, const boost::program_options::options_description& options,
    const boost::program_options::positional_options_description& positions = {}) {
  namespace po = boost::program_options;
  po::command_line_parser parser(arguments);
  parser.options(options).positional(positions);
  parser.style(po::command_line_style::unix_style & ~po::command_line_style::allow_guessing);
  po::variables_map values;
  po::store(parser.run(), values);
  if (values.count("help") == 0) po::notify(values);
  return values;
}

/// The same with an option --help, which is answered with `usage` and the options. False if that was asked for.
inline bool parseOrHelp(const std::vector<std::string>& arguments, const std::string& usage,
                        boost::program_options::options_description options,
                        const boost::program_options::positional_options_description& positions = {}) {
  options.add_options()("help,h", "print this text");
  const bool is_help = parseCommandLine(arguments, options, positions).count("help") > 0;
  if (is_help) std::cout << usage << "\n" << options;
  return !is_help;
}

/// For a node, whose other arguments are those of ROS: prints `help` if --help or -h is among them. True if it was.
inline bool printedHelp(int argc, char** argv, const char* help) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument != "--help" && argument != "-h") continue;
    std::cout << help;
    return true;
  }
  return false;
}

}  // namespace semantic_mht_slam
