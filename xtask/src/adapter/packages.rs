//! Commands that install Mesa's software Vulkan driver, or tools for tests, with the system's package manager.

use std::fmt;
use std::process::Command;

use super::facts::Packages;

/// One command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line(Vec<&'static str>);

impl Line {
    /// The command line as a process to start.
    pub fn command(&self) -> Command {
        let mut command = Command::new(self.0[0]);
        command.args(&self.0[1..]);
        command
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join(" "))
    }
}

/// Steps that install a package. If an attempt fails, the next one is tried. An attempt is a sequence of command lines
/// that must all succeed. Neither list is ever empty.
#[derive(Debug, PartialEq, Eq)]
pub struct Install {
    /// Attempts, the most promising first.
    pub attempts: Vec<Vec<Line>>,
}

impl fmt::Display for Install {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.attempts.first().into_iter().flatten().map(Line::to_string);
        f.write_str(&lines.collect::<Vec<_>>().join(" && "))
    }
}

/// Packages to install.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// Mesa's lavapipe and the Vulkan loader.
    Driver,
    /// Vulkan's validation layers and Xvfb, a display without a screen.
    Checks,
}

/// A package manager: its name, its distributions and its commands.
struct Manager {
    program: &'static str,
    /// `ID` or `ID_LIKE` of the distributions that use this manager by default.
    systems: &'static [&'static str],
    /// Command that fetches package lists; none for managers that fetch them automatically.
    refresh: Option<&'static [&'static str]>,
    /// Command that installs packages; their names are appended.
    install: &'static [&'static str],
    /// Mesa's lavapipe and the Vulkan loader.
    driver: &'static [&'static str],
    /// The validation layers and Xvfb.
    checks: &'static [&'static str],
}

const MANAGERS: &[Manager] = &[
    Manager {
        program: "apt-get",
        systems: &["debian", "ubuntu"],
        refresh: Some(&["apt-get", "update"]),
        install: &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "install", "--yes", "--no-install-recommends"],
        driver: &["mesa-vulkan-drivers", "libvulkan1"],
        checks: &["vulkan-validationlayers", "xvfb"],
    },
    Manager {
        program: "dnf",
        systems: &["fedora", "rhel", "centos"],
        refresh: None,
        install: &["dnf", "install", "--assumeyes"],
        driver: &["mesa-vulkan-drivers", "vulkan-loader"],
        checks: &["vulkan-validation-layers", "xorg-x11-server-Xvfb"],
    },
    Manager {
        program: "pacman",
        systems: &["arch"],
        refresh: Some(&["pacman", "-Sy", "--noconfirm"]),
        install: &["pacman", "-S", "--needed", "--noconfirm"],
        driver: &["vulkan-swrast", "vulkan-icd-loader"],
        checks: &["vulkan-validation-layers", "xorg-server-xvfb"],
    },
    Manager {
        program: "zypper",
        systems: &["suse", "opensuse"],
        refresh: None,
        install: &["zypper", "--non-interactive", "install"],
        driver: &["libvulkan_lvp", "libvulkan1"],
        checks: &["vulkan-validationlayers", "xorg-x11-server-Xvfb"],
    },
    Manager {
        program: "apk",
        systems: &["alpine"],
        refresh: None,
        install: &["apk", "add", "--no-cache"],
        driver: &["mesa-vulkan-swrast", "vulkan-loader"],
        checks: &["vulkan-validation-layers", "xvfb"],
    },
];

/// Returns the steps to install a package on this machine.
///
/// The distribution's own manager is preferred. Lists are fetched first if there are none, and otherwise only after a
/// failed attempt.
///
/// # Errors
/// Returns the reason nothing can be installed, and what to do about it.
pub fn plan(packages: &Packages, want: Want) -> Result<Install, String> {
    let Packages { system_ids, programs, root, apt_lists, pacman_databases, terminal } = packages;
    let present = |manager: &&Manager| programs.contains(&manager.program);
    let native = |manager: &&Manager| system_ids.iter().any(|id| manager.systems.contains(&&**id));
    let manager = MANAGERS.iter().filter(present).find(native);
    let Some(manager) = manager.or_else(|| MANAGERS.iter().find(present)) else {
        let what = match want {
            Want::Driver => "a Vulkan driver, such as Mesa's lavapipe,",
            Want::Checks => "Vulkan's validation layers and Xvfb",
        };
        return Err(format!(
            "no package manager known here (apt-get, dnf, pacman, zypper, apk) is present: install {what} by hand"
        ));
    };
    let sudo = programs.contains(&"sudo");
    let prefix: &[&str] = match (root, sudo, terminal) {
        (true, _, _) | (false, false, _) => &[],
        (false, true, true) => &["sudo"],
        // No terminal: `sudo` must not ask for a password.
        (false, true, false) => &["sudo", "-n"],
    };
    let line = |words: &[&'static str]| Line([prefix, words].concat());
    let names = if want == Want::Driver { manager.driver } else { manager.checks };
    let install = line(&[manager.install, names].concat());
    let listed = match manager.program {
        "apt-get" => *apt_lists,
        "pacman" => *pacman_databases,
        _ => true,
    };
    let attempts = match manager.refresh {
        None => vec![vec![install]],
        Some(refresh) if listed => vec![vec![install.clone()], vec![line(refresh), install]],
        Some(refresh) => vec![vec![line(refresh), install]],
    };
    let install = Install { attempts };
    if !root && !sudo {
        return Err(format!("sudo is not installed; run as root: {install}"));
    }
    Ok(install)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(system: &str, programs: &[&'static str]) -> Packages {
        Packages {
            system_ids: system.split_whitespace().map(str::to_owned).collect(),
            programs: programs.to_vec(),
            root: true,
            apt_lists: true,
            pacman_databases: true,
            terminal: false,
        }
    }

    fn shown(packages: &Packages) -> String {
        plan(packages, Want::Driver).expect("a plan").to_string()
    }

    const APT: &str = "env DEBIAN_FRONTEND=noninteractive apt-get install --yes \
                       --no-install-recommends mesa-vulkan-drivers libvulkan1";

    #[test]
    fn lists_are_fetched_first_where_there_are_none() {
        let debian = facts("debian", &["apt-get"]);
        assert_eq!(shown(&debian), APT);
        let fresh = Packages { apt_lists: false, ..debian };
        assert_eq!(shown(&fresh), format!("apt-get update && {APT}"));
        assert_eq!(plan(&fresh, Want::Driver).expect("a plan").attempts.len(), 1);
    }

    #[test]
    fn old_lists_get_a_second_attempt() {
        let attempts = plan(&facts("debian", &["apt-get"]), Want::Driver).expect("a plan").attempts;
        assert_eq!(attempts.len(), 2);
        assert_eq!(attempts[1][0].to_string(), "apt-get update");
        assert_eq!(attempts[1][1], attempts[0][0]);
    }

    #[test]
    fn others_use_sudo_and_never_wait_for_a_password_without_a_terminal() {
        let user = Packages { root: false, ..facts("debian", &["apt-get", "sudo"]) };
        assert_eq!(shown(&user), format!("sudo -n {APT}"));
        assert_eq!(shown(&Packages { terminal: true, ..user }), format!("sudo {APT}"));
        let bare = Packages { root: false, ..facts("debian", &["apt-get"]) };
        let reason = plan(&bare, Want::Driver).expect_err("nobody can install");
        assert!(reason.contains("as root") && reason.contains(APT), "{reason}");
    }

    #[test]
    fn the_distributions_own_manager_is_preferred() {
        let fedora = facts("fedora", &["apt-get", "dnf"]);
        assert!(shown(&fedora).starts_with("dnf install --assumeyes"));
        // A distribution that only its `ID_LIKE` identifies.
        let leap = facts("opensuse-leap suse opensuse", &["apt-get", "zypper"]);
        assert!(shown(&leap).starts_with("zypper --non-interactive install"));
        assert!(shown(&facts("unheard-of", &["apk"])).starts_with("apk add"));
    }

    #[test]
    fn every_manager_has_a_plan_and_none_is_an_error() {
        for manager in MANAGERS {
            let shown = shown(&facts(manager.systems[0], &[manager.program]));
            assert!(shown.contains(manager.program), "{shown}");
            let checks =
                plan(&facts(manager.systems[0], &[manager.program]), Want::Checks).expect("a plan").to_string();
            assert!(checks.contains("validation") && checks.to_lowercase().contains("xvfb"), "{checks}");
        }
        assert!(plan(&facts("debian", &["sudo"]), Want::Driver).is_err_and(|reason| reason.contains("lavapipe")));
    }

    #[test]
    fn a_line_starts_its_first_word_with_the_others_as_arguments() {
        let command = Line(vec!["sudo", "apt-get", "update"]).command();
        assert_eq!(command.get_program(), "sudo");
        assert_eq!(command.get_args().collect::<Vec<_>>(), ["apt-get", "update"]);
    }
}
