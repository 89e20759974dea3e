//! JSON values that know where they stand in the file, so that every complaint names its field.

use serde_json::{Map, Value};
use std::fmt;

/// What is wrong with the file or the arguments.
#[derive(Debug)]
pub(crate) struct Malformed(String);

impl Malformed {
    pub(crate) fn new(field: &str, what: &str) -> Self {
        Self(if field.is_empty() { format!("the case: {what}") } else { format!("{field}: {what}") })
    }
}

impl fmt::Display for Malformed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Parses a file; syntax errors name the field they stand in.
pub(crate) fn parse(text: &str) -> Result<Value, Malformed> {
    let mut json = serde_json::Deserializer::from_str(text);
    let complain =
        |path: String, error: &serde_json::Error| Malformed::new(path.trim_end_matches('.'), &error.to_string());
    let value = serde_path_to_error::deserialize(&mut json)
        .map_err(|error| complain(error.path().to_string().replace('?', ""), error.inner()))?;
    json.end().map_err(|error| complain(String::new(), &error))?;
    Ok(value)
}

/// A value and its path from the root of the case.
#[derive(Clone, Debug)]
pub(crate) struct Field<'a> {
    value: &'a Value,
    path: String,
}

impl<'a> Field<'a> {
    pub(crate) fn root(value: &'a Value) -> Self {
        Self { value, path: String::new() }
    }

    pub(crate) fn value(&self) -> &'a Value {
        self.value
    }

    pub(crate) fn malformed(&self, what: &str) -> Malformed {
        Malformed::new(&self.path, what)
    }

    /// The member with this key, if there is one.
    pub(crate) fn get(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key)?;
        let path = if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        Some(Self { value, path })
    }

    pub(crate) fn need(&self, key: &str) -> Result<Self, Malformed> {
        self.object()?;
        let path = if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        self.get(key).ok_or_else(|| Malformed::new(&path, "is missing"))
    }

    pub(crate) fn object(&self) -> Result<&'a Map<String, Value>, Malformed> {
        self.value.as_object().ok_or_else(|| self.malformed("is not an object"))
    }

    pub(crate) fn items(&self) -> Result<Vec<Self>, Malformed> {
        let items = self.value.as_array().ok_or_else(|| self.malformed("is not a list"))?;
        let item = |(i, value)| Self { value, path: format!("{}[{i}]", self.path) };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// A list of exactly `N` items.
    pub(crate) fn fixed<const N: usize>(&self) -> Result<[Self; N], Malformed> {
        let items = self.items()?;
        let given = items.len();
        items.try_into().map_err(|_| self.malformed(&format!("has {given} items instead of {N}")))
    }

    /// A finite number.
    pub(crate) fn number(&self) -> Result<f64, Malformed> {
        let number = self.value.as_f64().filter(|n| n.is_finite());
        number.ok_or_else(|| self.malformed(&format!("{} is not a finite number", self.value)))
    }

    /// A whole number in `range`.
    pub(crate) fn whole(&self, range: std::ops::RangeInclusive<u32>) -> Result<u32, Malformed> {
        let number = self.number()?;
        let whole = (number.fract() == 0.0 && number >= 0.0 && number <= f64::from(u32::MAX)).then_some(number as u32);
        whole.filter(|n| range.contains(n)).ok_or_else(|| {
            let (low, high) = (range.start(), range.end());
            self.malformed(&format!("{} is not a whole number in {low} ..= {high}", self.value))
        })
    }

    pub(crate) fn text(&self) -> Result<&'a str, Malformed> {
        self.value.as_str().ok_or_else(|| self.malformed("is not a string"))
    }

    /// `[r, g, b]`, each 0 ..= 255.
    pub(crate) fn colour(&self) -> Result<[u8; 3], Malformed> {
        let [r, g, b] = self.fixed()?;
        let channel = |f: Self| Ok(f.whole(0..=255)? as u8);
        Ok([channel(r)?, channel(g)?, channel(b)?])
    }
}
