#pragma once
#include <span>
#include <string>

#include "tools/commands/command.h"

namespace ossa::commands {

/// To be called before any file is opened. Replaces standard streams that a shell closed (`>&-`) by
/// ones that fail; otherwise the next opened file would get their number and the printed text.
/// Ctrl-C, SIGTERM and a closed terminal (unless nohup ignores it) are recorded for Interrupted();
/// a second one, half a second later or more, ends the program at once. A closed pipe and a file
/// size limit become failures of the write.
void PrepareProcess();

/// Prints to stderr for the user, ignoring failures: a full or closed stderr must not end a long
/// run.
void PrintError(const std::string& text);

/// Whether stderr is a terminal on which a line can be rewritten (TERM is not dumb).
bool CanMoveCursor();

/// Whether messages may have colours: on such a terminal, unless NO_COLOR is set
/// (https://no-color.org).
bool HasColours();

/// Runs the command that the arguments name, or shows the commands or the version. Returns the exit
/// status: 0; 2 for wrong usage; 1 for any other failure, with one line on stderr.
int RunCommandOf(std::span<const Command> commands, const std::string& version, int argc,
                 char** argv);

/// To be called last, with the exit status so far: returns 1 with a line on stderr if stdout could
/// not be written (a full disk), and ends by SIGPIPE, as shells expect, if its reader closed the
/// pipe (`ossa info FILE | head -1`). `error_number`: why printing failed before.
int EndOutput(int status, int error_number = 0);

}  // namespace ossa::commands
