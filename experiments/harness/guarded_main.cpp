// SPDX-License-Identifier: GPL-3.0-or-later
#include <cerrno>
#include <iostream>
#include <new>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/progress.hpp"
#include "experiments/harness/stop_signal.hpp"
#include "solver/error.hpp"

namespace esfem {

int guarded_main(const std::function<int()>& body) {
  const auto report = [](const std::string& message, int exit_code) {
    clear_progress_line();
    std::cerr << program_invocation_short_name << ": " << message << std::endl;
    return exit_code;
  };
  try {
    return body();
  } catch (const InputError& error) {
    return report(error.what(), exit_usage);
  } catch (const NumericsError& error) {
    return report(error.what(), exit_numerics);
  } catch (const StoppedError& error) {
    return report(error.what(), stop_signal() == 0 ? exit_numerics : exit_signal + stop_signal());
  } catch (const std::bad_alloc&) {
    return report("out of memory", exit_numerics);
  } catch (const std::exception& error) {
    return report(std::string("unexpected error: ") + error.what(), exit_numerics);
  }
}

}  // namespace esfem
