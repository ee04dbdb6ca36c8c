;;; plclint.el --- PLC programs with eglot  -*- lexical-binding: t; -*-

;; Package-Requires: ((emacs "28.1") (eglot "1.9"))

;;; Commentary:

;; A mode for PLC programs, served by `plclint server'.  Emacs 29 has eglot built in; for Emacs 28 it is a package.

;;; Code:

(defgroup plclint nil
  "Linter for PLC programs."
  :group 'tools)

(defcustom plclint-program "plclint"
  "The program, by its name on the path or by its path."
  :type 'string)

(defconst plclint-extensions
  '("awl" "stl" "s5" "il" "st" "ld" "gr7" "sfc" "dfb" "fef" "scy")
  "Extensions of PLC programs, in lower case.")

(defvar plclint-mode-syntax-table
  (let ((table (make-syntax-table)))
    ;; (* comments *) of PL7, // comments of Siemens, "symbols" and 'texts'.
    (modify-syntax-entry ?\( "()1" table)
    (modify-syntax-entry ?\) ")(4" table)
    (modify-syntax-entry ?* ". 23" table)
    (modify-syntax-entry ?/ ". 12c" table)
    (modify-syntax-entry ?\n "> c" table)
    (modify-syntax-entry ?\" "\"" table)
    (modify-syntax-entry ?% "_" table)
    (modify-syntax-entry ?_ "_" table)
    table)
  "Syntax of `plclint-mode'.")

;;;###autoload
(define-derived-mode plclint-mode prog-mode "PLC"
  "Major mode for PLC programs: Schneider PL7 and Siemens STEP 7 and STEP 5."
  (setq-local comment-start "(* ")
  (setq-local comment-end " *)")
  (setq-local comment-start-skip "\\((\\*\\|//\\)[ \t]*"))

(dolist (extension plclint-extensions)
  (dolist (spelt (list extension (upcase extension)))
    (add-to-list 'auto-mode-alist (cons (concat "\\." spelt "\\'") 'plclint-mode))))

(defun plclint--command (&rest _)
  "How the server is started."
  (list plclint-program "server"))

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(plclint-mode . plclint--command)))

(autoload 'eglot-ensure "eglot")
(add-hook 'plclint-mode-hook #'eglot-ensure)

(provide 'plclint)
;;; plclint.el ends here
