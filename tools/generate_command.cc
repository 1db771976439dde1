#include <iostream>
#include <memory>
#include <string>

#include "tools/commands.h"
#include "tools/completions.h"
#include "tools/flags.h"
#include "tools/man_page.h"

namespace lanewise {

void add_generate_command(CLI::App& app) {
  enum class Kind { kMan, kBash, kZsh, kFish };
  CLI::App* command = app.add_subcommand("generate", "Print the man page, or the completions of a shell");
  command->group("");  // not in --help: it is for the build
  const auto kind = std::make_shared<Kind>(Kind::kMan);
  add_choice<Kind>(*command, "KIND", *kind,
                   {{"man", Kind::kMan}, {"bash", Kind::kBash}, {"zsh", Kind::kZsh}, {"fish", Kind::kFish}},
                   "What is printed")
      ->required();
  command->callback([&app, kind] {
    const Command program = read_command(app);
    switch (*kind) {
      case Kind::kMan:
        std::cout << man_page(program);
        break;
      case Kind::kBash:
        std::cout << bash_completions(program);
        break;
      case Kind::kZsh:
        std::cout << zsh_completions(program);
        break;
      case Kind::kFish:
        std::cout << fish_completions(program);
        break;
    }
  });
}

}  // namespace lanewise
