//! A machine of QEMU with a display and a serial line, driven by the test: sockets that it inherits, so that there is
//! no address to race for, and a time limit on every answer.

use super::firmware::WATCHDOG;
use std::io::{BufRead, BufReader, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// A running machine; it ends with the value.
pub(crate) struct Machine {
    qemu: Child,
    monitor: BufReader<UnixStream>,
    serial: BufReader<UnixStream>,
    /// Where dumps go.
    folder: PathBuf,
}

/// A dump of a screen.
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    rgb: Vec<u8>,
}

impl Machine {
    /// Starts a firmware.
    pub(crate) fn start(machine: &str, image: &Path) -> Self {
        let (monitor, its_monitor) = UnixStream::pair().unwrap();
        let (serial, its_serial) = UnixStream::pair().unwrap();
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{machine}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        // Its standard streams are the sockets.
        let devices = ["socket,id=monitor,fd=0", "socket,id=serial,fd=1"];
        let qemu = Command::new("qemu-system-arm")
            .args(["-machine", machine, "-display", "none", "-chardev", devices[0], "-chardev", devices[1]])
            .args(["-mon", "chardev=monitor,mode=control", "-serial", "chardev:serial", "-kernel"])
            .arg(image)
            .stdin(OwnedFd::from(its_monitor))
            .stdout(OwnedFd::from(its_serial))
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        for socket in [&monitor, &serial] {
            socket.set_read_timeout(Some(WATCHDOG)).unwrap();
        }
        let mut machine = Self { qemu, monitor: BufReader::new(monitor), serial: BufReader::new(serial), folder };
        machine.answer("QMP");
        machine.command("qmp_capabilities", "{}");
        machine
    }

    /// Sends bytes over the serial line.
    pub(crate) fn send(&mut self, bytes: &[u8]) {
        self.serial.get_mut().write_all(bytes).unwrap();
    }

    /// The next line from the serial line.
    pub(crate) fn line(&mut self) -> String {
        let mut line = String::new();
        self.serial.read_line(&mut line).unwrap();
        assert!(line.ends_with('\n'), "the machine stopped after {line:?}");
        line.trim_end().to_owned()
    }

    /// What the screen shows.
    pub(crate) fn screen(&mut self) -> Picture {
        let path = self.folder.join("screen.ppm");
        self.command("screendump", &format!("{{\"filename\": {path:?}}}"));
        Picture::parse(&std::fs::read(path).unwrap())
    }

    /// Bytes of its memory.
    pub(crate) fn memory(&mut self, address: u32, size: usize) -> Vec<u8> {
        let path = self.folder.join("memory");
        self.command("pmemsave", &format!("{{\"val\": {address}, \"size\": {size}, \"filename\": {path:?}}}"));
        std::fs::read(path).unwrap()
    }

    /// Gives a command to the monitor and waits until it is done.
    fn command(&mut self, name: &str, arguments: &str) {
        let text = format!("{{\"execute\": \"{name}\", \"arguments\": {arguments}}}\n");
        self.monitor.get_mut().write_all(text.as_bytes()).unwrap();
        self.answer("return");
    }

    /// Waits for an answer of this kind; events in between are passed over.
    fn answer(&mut self, kind: &str) {
        loop {
            let mut line = String::new();
            self.monitor.read_line(&mut line).unwrap();
            assert!(!line.is_empty() && !line.starts_with("{\"error\""), "the monitor says {line:?}");
            if line.starts_with(&format!("{{\"{kind}\"")) {
                return;
            }
        }
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        let _ = self.qemu.kill();
        let _ = self.qemu.wait();
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

impl Picture {
    /// A PPM of 8 bits a channel, as QEMU writes it: three lines, then the bytes.
    fn parse(bytes: &[u8]) -> Self {
        let mut parts = bytes.splitn(4, |byte| *byte == b'\n');
        let mut line = || String::from_utf8_lossy(parts.next().unwrap_or_default()).into_owned();
        let [magic, size, depth] = [line(), line(), line()];
        assert_eq!([magic.as_str(), depth.as_str()], ["P6", "255"]);
        let (width, height) = size.split_once(' ').unwrap();
        let (width, height) = (width.parse().unwrap(), height.parse().unwrap());
        let rgb = parts.next().unwrap_or_default().to_vec();
        assert_eq!(rgb.len(), 3 * (width * height) as usize);
        Self { width, height, rgb }
    }

    /// Red, green, blue.
    pub(crate) fn pixel(&self, x: u32, y: u32) -> [u8; 3] {
        let at = 3 * (y * self.width + x) as usize;
        self.rgb[at..at + 3].try_into().unwrap()
    }
}
