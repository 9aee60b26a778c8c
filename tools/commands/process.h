#pragma once
#include <span>
#include <string>

#include "tools/commands/command.h"

namespace ossa::commands {

/// To be called before anything is opened. Standard streams that a shell closed (`>&-`) become ones
/// that fail: else the next file opened would get their number and what is printed would end in it.
/// Ctrl-C, SIGTERM and a terminal that goes away (unless nohup said otherwise) are noted, to be
/// asked for with Interrupted(); a second one, half a second later or more, ends the program at
/// once. A reader that went away and a file that may grow no more are failures of the write.
void PrepareProcess();

/// One line, or part of one, for people: on stderr, whatever becomes of it. A stderr that is full
/// or closed is no reason to end hours of work.
void Say(const std::string& text);

/// Whether stderr is a terminal on which a line can be written anew (TERM is not dumb).
bool CanMoveCursor();

/// Whether what is said may have colours: on such a terminal, unless NO_COLOR says otherwise
/// (https://no-color.org).
bool HasColours();

/// Runs the command that the arguments name, or shows the commands or the version. The exit status:
/// 0; 2 for wrong usage; 1 for any other failure, of which stderr says one line.
int RunCommandOf(std::span<const Command> commands, const std::string& version, int argc,
                 char** argv);

/// To be called last, with the exit status so far: 1 with a line on stderr when what was printed
/// did not reach stdout (a full disk), and the quiet end by SIGPIPE that a shell expects when its
/// reader had enough (`ossa info FILE | head -1`). `error_number` is why printing failed before.
int EndOutput(int status, int error_number = 0);

}  // namespace ossa::commands
